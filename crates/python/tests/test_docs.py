"""What is exported is documented, and its documentation runs."""

import inspect

import pontoon as pt


def public():
    """What a user may call, by its name."""
    for name in pt.__all__:
        thing = getattr(pt, name)
        if inspect.isclass(thing):
            yield name, thing
            for own, member in vars(thing).items():
                if not own.startswith("_") and (callable(member) or isinstance(member, property)):
                    yield f"{name}.{own}", member
        elif callable(thing):
            yield name, thing


def test_every_public_name_has_an_example():
    names = dict(public())
    assert len(names) > 40
    without = [name for name, thing in names.items() if ">>>" not in (inspect.getdoc(thing) or "")]
    assert without == []
