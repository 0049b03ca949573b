"""One file a scene: how it is drawn; a scene's own file draws nothing."""
