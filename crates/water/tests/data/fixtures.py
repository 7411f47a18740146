"""Makes the small netCDF files that the tests read: two modules, their freedoms and frequencies out of order.

    pip install scipy xarray netcdf4; python fixtures.py
Knows the formulas that the tests hold the files against. Does not know physics: the numbers are none.
"""

from pathlib import Path

import numpy as np
import xarray as xr

NAMES = [f"m{m:02d}__{freedom}" for m in (1, 2) for freedom in ("heave", "pitch", "roll")]
RADIATING = [NAMES[i] for i in (3, 4, 5, 0, 1, 2)]
INFLUENCED = [NAMES[i] for i in (0, 2, 1, 3, 5, 4)]
OMEGA = [1.5, np.inf, 0.0, 0.5]


def added_mass(i, j, omega):
    """Half a unit from symmetric above the diagonal; i is the force, j the motion."""
    return 1000 + 10 * (i + j) + (0.5 if j > i else 0) + (-100 if np.isinf(omega) else omega)


def damping(i, j, omega):
    """None at 0 and at infinite frequency, where codes write no number."""
    return np.nan if np.isinf(omega) else omega * (50 + i + j)


def table(of):
    """Values over radiating freedom, frequency and influenced freedom."""
    place = NAMES.index
    return [[[of(place(i), place(j), omega) for i in INFLUENCED] for omega in OMEGA] for j in RADIATING]


def main():
    dims = ("radiating_dof", "omega", "influenced_dof")
    data = xr.Dataset(
        {"added_mass": (dims, table(added_mass)), "radiation_damping": (dims, table(damping))},
        coords={
            "omega": OMEGA,
            "radiating_dof": RADIATING,
            "influenced_dof": INFLUENCED,
            "rho": 1000.0,
            "g": 9.81,
            "water_depth": np.inf,
        },
        attrs={"capytaine_version": "3.0.0", "hull": "box 12 x 6 x 0.2 m"},
    )
    here = Path(__file__).resolve().parent
    data.to_netcdf(here / "two_modules_classic.nc", engine="scipy", format="NETCDF3_64BIT")
    data.to_netcdf(here / "two_modules.nc", engine="netcdf4", format="NETCDF4")
    # a file with bottom, compressed
    shallow = data.assign_coords(water_depth=4.0)
    packed = {name: {"zlib": True, "shuffle": True} for name in ("added_mass", "radiation_damping")}
    shallow.to_netcdf(here / "two_modules_4_m.nc", engine="netcdf4", format="NETCDF4", encoding=packed)


if __name__ == "__main__":
    main()
