"""Mitsuba 3 scene files: elements, and the order in which a scene's parts are written."""

from html import escape

BLANK = object()  # an empty line among an element's children


class Element:
    """An XML element: attributes in the order given; children are elements, `Comment`s or BLANK."""

    def __init__(self, tag, *children, **attributes):
        self.tag = tag
        self.children = list(children)
        self.attributes = attributes

    def lines(self, indent=""):
        attributes = "".join(f' {name}="{escape(_text(value))}"' for name, value in self.attributes.items())
        if not self.children:
            return [f"{indent}<{self.tag}{attributes}/>"]
        lines = [f"{indent}<{self.tag}{attributes}>"]
        for child in self.children:
            lines.extend([""] if child is BLANK else child.lines(indent + "  "))
        lines.append(f"{indent}</{self.tag}>")
        return lines


class Comment:
    def __init__(self, text):
        self.text = text

    def lines(self, indent=""):
        return [f"{indent}<!-- {self.text} -->"]


def _text(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{round(value, 6) + 0.0:.6g}"
    if isinstance(value, (tuple, list)):
        return ", ".join(_text(item) for item in value)
    return str(value)


def number(name, value):
    return Element("float", name=name, value=value)


def integer(name, value):
    return Element("integer", name=name, value=value)


def boolean(name, value):
    return Element("boolean", name=name, value=value)


def string(name, value):
    return Element("string", name=name, value=value)


def rgb(name, value):
    return Element("rgb", name=name, value=value)


def ref(identifier):
    return Element("ref", id=identifier)


def to_world(*steps):
    """A transform of the steps given, the first applied first."""
    return Element("transform", *steps, name="to_world")


def document(header, scene):
    """The text of a scene file: `header`, lines of what the scene is and stresses, comes first."""
    lines = ['<?xml version="1.0" encoding="utf-8"?>', "<!--"]
    lines += [f"  {line}" if line else "" for line in header.strip("\n").split("\n")]
    lines += ["-->", *scene.lines()]
    return "\n".join(lines) + "\n"
