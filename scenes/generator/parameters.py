"""Declares a scene's parameters."""

import dataclasses


def parameter(default, meaning, low, high):
    """A field of a scene's Parameters: its default, unit and meaning, and the range that gives a sound scene."""
    return dataclasses.field(default=default, metadata={"meaning": meaning, "range": (low, high)})


class Checked:
    """Base of the Parameters of a scene: refuses values outside their ranges."""

    def __post_init__(self):
        for field in dataclasses.fields(self):
            low, high = field.metadata["range"]
            value = getattr(self, field.name)
            if not low <= value <= high:
                raise ValueError(f"{field.name} must be {low} to {high}, not {value}")
