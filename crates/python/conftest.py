"""Tests run where the paths of examples begin, at the root of the repository; what they start finds this package."""

from pathlib import Path

import pytest

import pontoon

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def at_the_root(monkeypatch):
    monkeypatch.chdir(ROOT)
    monkeypatch.setenv("PYTHONPATH", str(Path(pontoon.__file__).parents[1]))
