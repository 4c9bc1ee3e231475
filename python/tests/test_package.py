"""The package says of itself what it is: stubs, docstrings, first lines of its page."""

import ast
import inspect
import re
import unittest

from places import ROOT

import gangwerk
import gangwerk.client


class Package(unittest.TestCase):
    def test_the_stubs_are_the_module(self):
        """Every name with its docstring and arguments, in both directions."""
        stub = ast.parse((ROOT / "python/gangwerk/__init__.pyi").read_text())
        documented = set()

        def compare(node, real, where):
            documented.add(where)
            if where.split(".")[-1] == "__init__":
                real = real.__objclass__ if hasattr(real, "__objclass__") else real
            else:
                self.assertEqual(inspect.cleandoc(real.__doc__ or ""), inspect.cleandoc(ast.get_docstring(node) or ""), where)
            if isinstance(node, ast.FunctionDef) and callable(real) and not node.decorator_list and node.name != "__init__":
                said = [arg.arg for arg in node.args.args + node.args.kwonlyargs if arg.arg != "self"]
                said += [node.args.kwarg.arg] if node.args.kwarg else []
                has = [name for name in inspect.signature(real).parameters if name != "self"]
                self.assertEqual(said, has, where)

        for node in stub.body:
            if isinstance(node, ast.FunctionDef):
                compare(node, getattr(gangwerk, node.name), node.name)
            elif isinstance(node, ast.ClassDef):
                kind = getattr(gangwerk, node.name)
                compare(node, kind, node.name)
                for inner in node.body:
                    if isinstance(inner, ast.FunctionDef) and inner.name != "__init__":
                        compare(inner, getattr(kind, inner.name), f"{node.name}.{inner.name}")
        for name in gangwerk._NATIVE:
            real = getattr(gangwerk, name)
            if inspect.isclass(real) and name != "Event":
                public = {f"{name}.{inner}" for inner in vars(real) if not inner.startswith("_")}
                self.assertLessEqual(public, documented)

    def test_the_first_lines_of_its_page_walk(self):
        page = (ROOT / "docs/python.md").read_text()
        first = re.search(r"```python\n(.*?)```", page, re.S).group(1)
        lines = [line for line in first.splitlines() if line.strip()]
        self.assertEqual(len(lines), 3)
        names = {}
        exec(first.replace("print(", "found = ("), names)
        self.assertAlmostEqual(names["found"], 0.278, delta=0.01)

    def test_every_scene_is_listed(self):
        scenes = gangwerk.scenes()
        files = {path.stem for path in (ROOT / "config/scenes").glob("*.toml")}
        self.assertEqual(scenes.keys(), files)
        self.assertTrue(all(scenes.values()))

    def test_what_is_refused_is_the_clients_exception(self):
        self.assertIs(gangwerk.Refused, gangwerk.client.Refused)


if __name__ == "__main__":
    unittest.main()
