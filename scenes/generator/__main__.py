"""Command line of the generator; see scripts/generate-scenes."""

import argparse
import dataclasses
import pathlib
import shutil
import sys

from . import bathroom, cornell_box, lamp, staircase, veranda

SCENES = {
    "cornell-box": cornell_box,
    "staircase": staircase,
    "bathroom": bathroom,
    "veranda": veranda,
    "lamp": lamp,
}


def parse_arguments():
    parser = argparse.ArgumentParser(prog="scripts/generate-scenes", description="Writes the shipped scenes.")
    parser.add_argument("--out", type=pathlib.Path, required=True, metavar="DIR", help="folder for <scene>/scene.xml")
    parser.add_argument("--set", action="append", default=[], metavar="SCENE.PARAMETER=VALUE",
                        help="another value for a scene's parameter, such as staircase.steps=20")
    parser.add_argument("--list", action="store_true", help="print scenes and their parameters, write nothing")
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="only these scenes")
    return parser.parse_args()


def chosen_parameters(settings):
    """Scene -> its parameters, after the SCENE.PARAMETER=VALUE settings. Raises ValueError with what is wrong."""
    parameters = {name: module.Parameters() for name, module in SCENES.items()}
    for setting in settings:
        target, equals, text = setting.partition("=")
        scene, _, key = target.partition(".")
        if not equals or scene not in parameters:
            raise ValueError(f'"{setting}" is not SCENE.PARAMETER=VALUE with a scene of {", ".join(SCENES)}')
        known = dataclasses.asdict(parameters[scene])
        if key not in known:
            raise ValueError(f'{scene} has no parameter "{key}"; it has {", ".join(known)}')
        kind = type(known[key])
        try:
            parameters[scene] = dataclasses.replace(parameters[scene], **{key: kind(text)})
        except ValueError as error:
            raise ValueError(f"{target}: {error}") from error
    return parameters


def print_parameters():
    for name, module in SCENES.items():
        print(f"{name}: {module.__doc__.splitlines()[0]}")
        for field in dataclasses.fields(module.Parameters):
            print(f"  {name}.{field.name}={field.default}  {field.metadata['meaning']}")


def write(folder, contents):
    """Makes the folder hold these files; meshes and textures of an older scene go."""
    for part in ("meshes", "textures"):
        if (folder / part).is_dir():
            shutil.rmtree(folder / part)
    for path, content in contents.items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)


def main():
    arguments = parse_arguments()
    if arguments.list:
        print_parameters()
        return 0
    try:
        parameters = chosen_parameters(arguments.set)
        for name in arguments.scenes:
            if name not in SCENES:
                raise ValueError(f'no scene "{name}"; there are {", ".join(SCENES)}')
        for name in arguments.scenes or SCENES:
            scene = SCENES[name].generate(parameters[name])
            contents = scene.files()
            write(arguments.out / name, contents)
            size = sum(len(content) for content in contents.values())
            print(f"{name}: {scene.triangles} triangles, {size / 1e6:.2f} MB")
    except (ValueError, OSError) as error:
        print(f"scripts/generate-scenes: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
