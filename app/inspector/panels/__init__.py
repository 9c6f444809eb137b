"""The dock panels, one file each: `build(gui, dispatch) -> update(snapshot)`."""
