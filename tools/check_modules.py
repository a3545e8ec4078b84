#!/usr/bin/env python3
"""Checks that modules and programs include only what they may.

    tools/check_modules.py [ROOT]

A module is a folder of ROOT/src (default: of this project) and a pellucid_module() call in ROOT/src/CMakeLists.txt. Its
files, C++ and GLSL alike, may include files of itself and of the modules that its USES reach, directly or through others.
Its SOURCES and SHADERS lie in its own folder, and modules use no circle. CMake itself would not notice: all modules share
one include folder.

Its HEADERS lie in ROOT/include/pellucid, where every header belongs to one module. They include public headers only, by the
same rule. pellucid.h includes all of them, belongs to no module, and no module includes it.
ROOT/apps, ROOT/examples and ROOT/python include no file of a module but public headers.

Prints one line for each offence and exits 1, or one line that all is well and exits 0.
"""
import os
import re
import sys

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]', re.MULTILINE)
CODE = (".h", ".hpp", ".cpp", ".glsl", ".vert", ".frag", ".comp", ".geom")
ALL_HEADERS = "pellucid.h"
VULKAN_HEADER = "vulkan.h"  # the one with types of Vulkan, which programs that lend no device need not have
PROGRAMS = ("apps", "examples", "python")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def read_modules(cmake_file):
    """Name of each module -> its keyword lists."""
    modules = {}
    text = re.sub(r"#.*", "", read(cmake_file))
    for call in re.finditer(r"\bpellucid_module\s*\(([^)]*)\)", text):
        name, *words = call.group(1).split()
        module = modules[name] = {"HEADERS": [], "SOURCES": [], "USES": [], "SHADERS": []}
        keyword = None
        for word in words:
            if word.isupper():
                keyword = word
                module.setdefault(keyword, [])
            else:
                module[keyword].append(word)
    return modules


def reach(modules, name):
    """The modules that `name` uses, directly or through others; itself only if in a circle."""
    seen, todo = set(), list(modules[name]["USES"])
    while todo:
        used = todo.pop()
        if used not in seen:
            seen.add(used)
            todo += modules.get(used, {"USES": []})["USES"]
    return seen


class Tree:
    def __init__(self, root):
        self.root, self.src = root, os.path.join(root, "src")
        self.public = os.path.join(root, "include", "pellucid")
        self.modules = read_modules(os.path.join(self.src, "CMakeLists.txt"))
        self.owners = {header: name for name, module in self.modules.items() for header in module["HEADERS"]}

    def includes(self, path):
        """Line, included file as written, and its module, for each include of a module's file. System and generated files
        have none; public headers without a module have "a header of no module"."""
        text = read(path)
        for match in INCLUDE.finditer(text):
            included = match.group(1)
            if included.startswith("pellucid/"):
                module = self.owners.get(included.removeprefix("pellucid/"), "a header of no module")
            else:
                module = self.module_of_private(os.path.dirname(path), included)
            if module:
                yield text.count("\n", 0, match.start()) + 1, included, module

    def module_of_private(self, folder, included):
        beside = os.path.normpath(os.path.join(folder, included))
        path = beside if os.path.exists(beside) else os.path.normpath(os.path.join(self.src, included))
        first = os.path.relpath(path, self.src).split(os.sep)[0]
        # A module's name counts even where there is no such file (any more).
        return first if first in self.modules else None

    def check_file(self, path, name):
        allowed = reach(self.modules, name) | {name}
        for line, included, used in self.includes(path):
            if used not in allowed:
                yield f"{os.path.relpath(path, self.root)}:{line}: includes {included}, but {name} does not use {used}"

    def check_public_only(self, path):
        for line, included, _ in self.includes(path):
            if not included.startswith("pellucid/"):
                yield f"{os.path.relpath(path, self.root)}:{line}: includes {included}, which is not public"


def code_below(folder):
    for parent, _, files in sorted(os.walk(folder)):
        yield from (os.path.join(parent, file) for file in sorted(files) if file.endswith(CODE))


def check_module(tree, name):
    for used in tree.modules[name]["USES"]:
        if used not in tree.modules:
            yield f"CMakeLists.txt: {name} uses {used}, which is no module"
    if name in reach(tree.modules, name):
        yield f"CMakeLists.txt: {name} uses itself through others"
    for file in tree.modules[name]["SOURCES"] + tree.modules[name]["SHADERS"]:
        if file.split("/")[0] != name:
            yield f"CMakeLists.txt: {file} is not in the folder of its module, {name}"
    for path in code_below(os.path.join(tree.src, name)):
        yield from tree.check_file(path, name)


def check_headers(tree):
    listed = sorted(header for module in tree.modules.values() for header in module["HEADERS"])
    there = sorted(set(os.listdir(tree.public)) - {ALL_HEADERS})
    for header in sorted(set(listed) ^ set(there)):
        yield f"{header}: " + ("belongs to no module" if header in there else "is not in include/pellucid")
    for header in sorted({header for header in listed if listed.count(header) > 1}):
        yield f"{header}: belongs to several modules"
    for header in set(listed) & set(there):
        path = os.path.join(tree.public, header)
        yield from tree.check_public_only(path)
        yield from tree.check_file(path, tree.owners[header])
    included = {file.removeprefix("pellucid/") for _, file, _ in tree.includes(os.path.join(tree.public, ALL_HEADERS))}
    for header in sorted(set(there) - included - {VULKAN_HEADER}):
        yield f"{ALL_HEADERS}: does not include {header}"


def check(tree):
    if not tree.modules:
        yield "CMakeLists.txt: has no pellucid_module()"
    for folder in sorted(os.listdir(tree.src)):
        if os.path.isdir(os.path.join(tree.src, folder)) and folder not in tree.modules:
            yield f"{folder}/: is no pellucid_module() of CMakeLists.txt"
    for name in tree.modules:
        yield from check_module(tree, name)
    yield from check_headers(tree)
    for folder in PROGRAMS:
        for path in code_below(os.path.join(tree.root, folder)):
            yield from tree.check_public_only(path)


def main():
    default = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir)
    tree = Tree(os.path.normpath(sys.argv[1] if len(sys.argv) > 1 else default))
    offences = list(check(tree))
    for offence in offences:
        print(offence)
    if not offences:
        print(f"modules: {', '.join(tree.modules)}: every include is allowed")
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main())
