#!/usr/bin/env python3
"""Checks that the rooms under src/ use only the rooms they say they use.

    tools/check_rooms.py [SRC]

A room is a folder of SRC (default: src/ beside this folder) and a pellucid_room() call in
SRC/CMakeLists.txt. Its files, C++ and GLSL alike, may include files of itself and of the rooms that
its USES reach, directly or through others; its SOURCES and SHADERS lie in its own folder, and rooms
use no circle. CMake itself would not notice: all rooms share one include folder.

Prints one line for each offence and exits 1, or one line that all is well and exits 0.
"""
import os
import re
import sys

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]', re.MULTILINE)
CODE = (".h", ".hpp", ".cpp", ".glsl", ".vert", ".frag", ".comp", ".geom")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def read_rooms(cmake_file):
    """Name of each room -> its keyword lists."""
    rooms = {}
    text = re.sub(r"#.*", "", read(cmake_file))
    for call in re.finditer(r"\bpellucid_room\s*\(([^)]*)\)", text):
        name, *words = call.group(1).split()
        room = rooms[name] = {"SOURCES": [], "USES": [], "SHADERS": []}
        keyword = None
        for word in words:
            if word.isupper():
                keyword = word
                room.setdefault(keyword, [])
            else:
                room[keyword].append(word)
    return rooms


def reach(rooms, name):
    """The rooms that `name` uses, directly or through others; itself only if in a circle."""
    seen, todo = set(), list(rooms[name]["USES"])
    while todo:
        used = todo.pop()
        if used not in seen:
            seen.add(used)
            todo += rooms.get(used, {"USES": []})["USES"]
    return seen


def included_room(folder, src, included, rooms):
    """The room that an include line leads into; None for system and generated files."""
    beside = os.path.normpath(os.path.join(folder, included))
    path = beside if os.path.exists(beside) else os.path.normpath(os.path.join(src, included))
    first = os.path.relpath(path, src).split(os.sep)[0]
    # A room's name counts even where there is no such file (any more).
    return first if first in rooms else None


def check_includes(src, rooms, name):
    allowed = reach(rooms, name) | {name}
    for folder, _, files in os.walk(os.path.join(src, name)):
        for file in sorted(files):
            if not file.endswith(CODE):
                continue
            path = os.path.join(folder, file)
            text = read(path)
            for match in INCLUDE.finditer(text):
                used = included_room(folder, src, match.group(1), rooms)
                if used and used not in allowed:
                    line = text.count("\n", 0, match.start()) + 1
                    yield (f"{os.path.relpath(path, src)}:{line}: includes {match.group(1)}, "
                           f"but {name} does not use {used}")


def check_room(src, rooms, name):
    for used in rooms[name]["USES"]:
        if used not in rooms:
            yield f"CMakeLists.txt: {name} uses {used}, which is no room"
    if name in reach(rooms, name):
        yield f"CMakeLists.txt: {name} uses itself through others"
    for file in rooms[name]["SOURCES"] + rooms[name]["SHADERS"]:
        if file.split("/")[0] != name:
            yield f"CMakeLists.txt: {file} is not in the folder of its room, {name}"
    yield from check_includes(src, rooms, name)


def check(src):
    rooms = read_rooms(os.path.join(src, "CMakeLists.txt"))
    if not rooms:
        yield "CMakeLists.txt: has no pellucid_room()"
    for folder in sorted(os.listdir(src)):
        if os.path.isdir(os.path.join(src, folder)) and folder not in rooms:
            yield f"{folder}/: is no pellucid_room() of CMakeLists.txt"
    for name in rooms:
        yield from check_room(src, rooms, name)


def main():
    default = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "src")
    src = os.path.normpath(sys.argv[1] if len(sys.argv) > 1 else default)
    offences = list(check(src))
    for offence in offences:
        print(offence)
    if not offences:
        print(f"rooms: {', '.join(read_rooms(os.path.join(src, 'CMakeLists.txt')))}: every include is allowed")
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main())
