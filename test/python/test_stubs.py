"""The stubs say what the module has."""
import ast
import inspect
import pathlib
import re

import semantic_octree

STUBS = ast.parse((pathlib.Path(semantic_octree.__file__).parent / "__init__.pyi").read_text())
KEPT = {"__bool__", "__copy__", "__deepcopy__", "__len__"}  # of the names with underscores


def arguments_of_stub(function):
    a = function.args
    rest = [f"**{a.kwarg.arg}"] if a.kwarg else []
    return [argument.arg for argument in a.args + a.kwonlyargs if argument.arg != "self"] + rest


def arguments_of_docstring(docstring, name):
    inside = re.match(rf"{name}\((.*)\) -> ", docstring.splitlines()[0]).group(1)
    inside = re.sub(r"\[[^\]]*\]", "", re.sub(r"\[[^\[\]]*\]", "", inside))
    names = [part.split(":")[0].split("=")[0].strip() for part in inside.split(",")]
    return [n for n in names if n not in ("self", "*", "arg0", "")]


def test_the_stubs_have_the_names_of_the_module():
    classes = {node.name for node in STUBS.body if isinstance(node, ast.ClassDef)}
    assert classes | {"__version__"} == set(semantic_octree.__all__)


def test_the_stubs_have_the_names_and_arguments_of_each_class():
    compared = 0
    for stub in STUBS.body:
        if not isinstance(stub, ast.ClassDef):
            continue
        cls = getattr(semantic_octree, stub.name)
        there = {n for n in vars(cls) if not n.startswith("_") or n in KEPT}
        described = {f.name: f for f in stub.body}
        assert set(described) - {"__init__"} == there, stub.name
        for name, function in described.items():
            member = inspect.getattr_static(cls, name)
            is_property = any(getattr(d, "id", "") == "property" for d in function.decorator_list)
            assert is_property == isinstance(member, property), name
            if is_property or (name.startswith("_") and name != "__init__"):
                continue
            docstring = getattr(cls, name).__doc__
            expected = [a if a != "**options" and a != "**filter" else "**kwargs" for a in arguments_of_stub(function)]
            assert arguments_of_docstring(docstring, name) == expected, f"{stub.name}.{name}"
            compared += 1
    assert compared > 20


def test_all_that_is_public_is_documented():
    for name in semantic_octree.__all__:
        cls = getattr(semantic_octree, name)
        if not inspect.isclass(cls):
            continue
        assert cls.__doc__
        for member in vars(cls):
            if not member.startswith("_"):
                assert len(getattr(cls, member).__doc__.splitlines()) > 0, f"{name}.{member}"
