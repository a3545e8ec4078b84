"""The stubs describe the module as it is, and every part of it has a description."""
import ast
import inspect
import re

import pellucid
import python_test
from python_test import ROOT, PythonTest

STUB = ROOT / "python" / "pellucid" / "__init__.pyi"


def stub_arguments(function):
    arguments = function.args
    names = [each.arg for each in arguments.posonlyargs + arguments.args if each.arg not in ("self", "cls")]
    names += [each.arg for each in arguments.kwonlyargs]
    return names + (["**"] if arguments.kwarg else [])


def module_arguments(doc):
    """Names of the arguments in the first line of a description, as pybind11 writes it."""
    inside = re.match(r"\w+\((.*)\)(?: -> .*)?$", doc.split("\n")[0]).group(1)
    while True:  # defaults and types may have commas in brackets
        shorter = re.sub(r"[(\[{<][^()\[\]{}<>]*[)\]}>]", "", inside)
        if shorter == inside:
            break
        inside = shorter
    names = [each.split(":")[0].split("=")[0].strip() for each in inside.split(",") if each.strip()]
    return ["**" if name.startswith("**") else name for name in names if name not in ("self", "*")]


def members(value):
    return {name: member for name, member in vars(value).items() if not name.startswith("_") or name == "__init__"}


def settable(value):
    return sorted(name for name, member in members(value).items() if isinstance(member, property) and member.fset)


class Interface(PythonTest):
    def setUp(self):
        super().setUp()
        tree = ast.parse(STUB.read_text(encoding="utf-8"))
        self.functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
        self.classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
        self.public = {name: value for name, value in vars(pellucid._pellucid).items() if not name.startswith("_")}

    def test_names(self):
        self.assertEqual(sorted(self.functions), sorted(n for n, v in self.public.items() if inspect.isbuiltin(v)))
        self.assertEqual(sorted(self.classes), sorted(n for n, v in self.public.items() if inspect.isclass(v)))

    def test_functions(self):
        for name, node in self.functions.items():
            with self.subTest(name):
                self.assertEqual(stub_arguments(node), module_arguments(self.public[name].__doc__))

    def test_classes(self):
        for name, node in self.classes.items():
            bound = self.public[name]
            if issubclass(bound, Exception):
                continue
            methods = {each.name: each for each in node.body if isinstance(each, ast.FunctionDef)}
            attributes = [each.target.id for each in node.body if isinstance(each, ast.AnnAssign)]
            with self.subTest(name):
                self.assertEqual(sorted(attributes), settable(bound))
                found = members(bound)
                if bound.__init__.__doc__ is None or "Initialize self" in bound.__init__.__doc__:
                    found.pop("__init__", None)
                elif "__init__" not in methods:
                    self.fail("the stub has no constructor")
                self.assertEqual(sorted([*methods, *attributes]), sorted(found))
            for method, stub in methods.items():
                with self.subTest(f"{name}.{method}"):
                    self.check_method(bound, method, stub)

    def check_method(self, bound, method, stub):
        decorators = [each.id for each in stub.decorator_list]
        member = vars(bound)[method]
        self.assertEqual("property" in decorators, isinstance(member, property))
        self.assertEqual("staticmethod" in decorators, isinstance(member, staticmethod))
        if isinstance(member, property):
            return
        expected = module_arguments(getattr(bound, method).__doc__)
        if method == "__init__" and expected == ["**"]:  # takes every property by name
            self.assertEqual(sorted(stub_arguments(stub)), settable(bound))
        else:
            self.assertEqual(stub_arguments(stub), expected)

    def test_every_part_has_a_description(self):
        def described(value):
            # The first line is the signature.
            doc = value.__doc__ or ""
            return len(doc.split("\n", 1)[1].strip() if "(" in doc.split("\n")[0] and "\n" in doc else doc.strip()) > 3

        for name, value in self.public.items():
            if name == "path_dtype":
                continue
            with self.subTest(name):
                self.assertTrue(described(value))
            if inspect.isclass(value) and not issubclass(value, Exception):
                for member in members(value):
                    if member != "__init__":
                        with self.subTest(f"{name}.{member}"):
                            self.assertTrue(described(getattr(value, member)))

    def test_registry(self):
        import json
        described = json.loads(self.run_cli("techniques", "--json").stdout)["techniques"]
        found = {each.name: each for each in pellucid.techniques()}
        for technique in described:
            if technique["name"] in pellucid.presets():
                continue
            parameters = [each["name"] for each in technique["parameters"]]
            self.assertEqual([each.name for each in found[technique["name"]].parameters], parameters)
        self.assertEqual(list(pellucid.presets()), ["fast", "balanced", "exact"])
        self.assertEqual(pellucid.__version__, self.run_cli("--version").stdout.strip())


if __name__ == "__main__":
    python_test.main()
