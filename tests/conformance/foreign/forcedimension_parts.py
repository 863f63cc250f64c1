"""forcedimension-core without the packages that no test uses, and with a library that has a part of libdrd's functions."""
import ctypes
import sys
import types
import typing


class Absent:
    """A function that the library lacks: the bindings declare all of them when they are imported."""

    def __init__(self, name):
        self.name = name

    def __call__(self, *_):
        raise NotImplementedError(self.name)


class Library(ctypes.CDLL):
    def __getattr__(self, name):
        try:
            return super().__getattr__(name)
        except AttributeError:
            return self.__dict__.setdefault(name, Absent(name))


class Module(types.ModuleType):
    """A package of which only classes, annotations and decorators are used."""

    def __getattr__(self, name):
        if name == "BaseModel":
            return types.SimpleNamespace
        return getattr(typing, name, lambda *_, **__: lambda function: function)


def import_from(folder):
    for name in ("pydantic", "pydantic_core", "typing_extensions"):
        sys.modules[name] = Module(name)
    ctypes.CDLL = Library
    sys.path.insert(0, folder)
