"""The tables that `diagnosis.py` prints."""

from __future__ import annotations

from collections import Counter

ENDS = ("unique", "group", "none", "wrong")
ALIKE = {"ratios (e, mu, phi, s2)": {"e", "mu", "phi", "s2"}, "with masses (I, M, v1, loss)": {"I", "M", "v1", "loss"}}


def print_told(told, names, *, each):
    """Print how planted mistakes were told, by assignment and quantity, and in all."""
    print("| assignment | quantity | submissions | told alone | in a group | not told | another told | unseen |")
    print("|---|---|" + "---:|" * 6)
    for name in names:
        quantities = {key[2] for key in told if key[0] == "planted" and key[1] == name}
        for quantity in sorted(quantities):
            print_row(f"{name} | {quantity}", told, lambda k, n=name, q=quantity: k[1] == n and k[2] == q)
        print_row(f"{name} | velocities: slips", told, lambda k, n=name: k[0] == "slip" and k[1] == n)
    for label, quantities in ALIKE.items():
        print_row(f"**all** | {label}", told, lambda k, q=quantities: k[2] in q)
    print_row("**all** | velocities: slips", told, lambda k: k[0] == "slip")
    if each:
        print_each(told)


def print_row(label, told, belongs):
    ends, unseen = Counter(), 0
    for key, count in told.items():
        if key[0] in {"planted", "slip"} and belongs(key):
            ends[key[4]] += count
        elif key[0] == "unseen" and belongs(key):
            unseen += count
    whole = ends.total()
    if whole:
        shares = " | ".join(f"{100 * ends[end] / whole:.1f} %" for end in ENDS)
        print(f"| {label} | {whole} | {shares} | {unseen} |")


def print_each(told):
    """Print each mistake that was not told alone in one case of twenty or more."""
    print("\n| assignment | quantity | mistake | submissions | alone | group | not told | another |")
    print("|---|---|---|" + "---:|" * 5)
    for at in sorted({key[:4] for key in told if key[0] in {"planted", "slip"}}):
        ends = {end: told[*at, end] for end in ENDS}
        whole = sum(ends.values())
        if ends["unique"] < 0.95 * whole:
            print(f"| {at[1]} | {at[2]} | {at[3]} | {whole} | " + " | ".join(str(ends[end]) for end in ENDS) + " |")


def print_right(told, names, kinds):
    """Print how right submissions were judged."""
    said = "told a mistake | formula wrong | value wrong | a measured number wrong | to a person | mean points"
    print(f"\n| assignment | noise | right ones | {said} |")
    print("|---|---|" + "---:|" * 7)
    noises = sorted({key[2] for key in told if key[0] == "right"})
    for name in (*names, "**all**"):
        for noise in noises:
            counts = Counter()
            for key, count in told.items():
                if key[0] == "right" and key[2] == noise and name in {key[1], "**all**"}:
                    counts[key[3]] += count
            whole = counts["all"]
            if whole:
                shares = " | ".join(f"{100 * counts[kind] / whole:.2f} %" for kind in kinds)
                print(f"| {name} | {noise:g} px | {whole} | {shares} | {counts['points'] / 100 / whole:.1f} |")
