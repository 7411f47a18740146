"""Tests run where the paths of examples begin, at the root of the repository; what they start finds this package."""

import importlib.util
from pathlib import Path

import pytest

import pontoon

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def at_the_root(monkeypatch):
    monkeypatch.chdir(ROOT)
    monkeypatch.setenv("PYTHONPATH", str(Path(pontoon.__file__).parents[1]))


# Examples that need what the package does not: they run where that is installed.
NEEDS = {"to_polars": "polars", "to_pandas": "pandas", "plot": "matplotlib"}


def pytest_collection_modifyitems(items):
    for item in items:
        needed = NEEDS.get(item.name.rsplit(".", 1)[-1])
        if needed and importlib.util.find_spec(needed) is None:
            item.add_marker(pytest.mark.skip(reason=f"{needed} is not installed"))
