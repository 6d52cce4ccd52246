"""Libraries that only some functions need: imported when such a function is called."""

import importlib
from typing import Any

Axes = Any  # matplotlib has no types

SOURCES = {
    "matplotlib": "Debian: apt install python3-matplotlib",
    "meshio": "Debian: apt install python3-meshio",
    "vtkmodules": "Debian: apt install python3-vtk9",
    "pyvista": "not in Debian 12: pip install pyvista",
}


def needed(module: str, purpose: str) -> Any:
    """The module; where it is not installed, the ImportError says how to install it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        source = SOURCES[module.partition(".")[0]]
        raise ImportError(f"{purpose} needs {module}: {error} ({source})", name=module) from error
