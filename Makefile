# `make demo` and `make test` do all the set-up by themselves; see README.md.
BIN := .venv/bin
SETUP_FILES := pyproject.toml constraints.txt tools/setup.sh

.PHONY: help demo test check accuracy bench mutants gallery clean

help:
	@echo "make demo      simulate, hand out, measure and grade a sample course (3 students)"
	@echo "make test      lint, types, import contracts and all tests"
	@echo "make check     lint, types and import contracts only (before every push)"
	@echo "make accuracy  the long accuracy runs against known truth"
	@echo "make bench     the benchmarks"
	@echo "make mutants   change what decides about grades one bit at a time and see that a test notices (ROOM=name: one room)"
	@echo "make gallery   the pictures of all scenes in docs/"
	@echo "make clean     remove the virtual environment and caches"

.venv/.runtime: $(SETUP_FILES)
	@tools/setup.sh runtime

.venv/.dev: $(SETUP_FILES)
	@tools/setup.sh dev

demo: .venv/.runtime
	@$(BIN)/vml demo

check: .venv/.dev
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/codespell vml_course assignments grader tests benchmarks *.md
	$(BIN)/mypy
	$(BIN)/lint-imports

test: check
	$(BIN)/pytest -n 2 -m "not accuracy"

accuracy: .venv/.dev
	$(BIN)/pytest -m accuracy -s -o faulthandler_timeout=0

bench: .venv/.dev
	@for script in benchmarks/*.py; do echo "== $$script"; $(BIN)/python $$script || exit 1; done

mutants: .venv/.dev
	$(BIN)/pip install --quiet --disable-pip-version-check "mutmut>=3.3"
	$(BIN)/python tools/mutants.py $(ROOM)

gallery: .venv/.dev
	$(BIN)/python tools/gallery.py

clean:
	rm -rf .venv build .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
