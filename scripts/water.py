"""Makes a water file for a bridge file by Capytaine: one closed box hull, cut into modules of heave, pitch and roll.

scripts/water tells how it is called. Knows the settings and meshes that thin hulls need, and the keys of a water file.
Does not know the bridge beyond the number and lengths of its modules, its water plane and its draught; a hull that is
no box is not made here.

Settings. The draught of such hulls is far below the size of a cell, so that one point a cell is wrong by tens of per
cent: cells have 2 x 2 Gauss points. In deep water the Green function keeps its Rankine part
(`low_freq_with_rankine_part`); with a bottom that setting is wrong in Capytaine 3.0.0 and `low_freq` is taken. With a
bottom frequencies near 0 come out as no number: such frequencies are left out and told.
"""

import argparse
import json
import logging
import math
import sys
import time
from pathlib import Path

import blake3
import capytaine as cpt
import numpy as np

FREEDOMS = ("heave", "pitch", "roll")
OMEGA = [*np.round(np.arange(0, 3.5, 0.2), 2), 3.6, 4.0, 4.4, 4.8, 5.2, 5.8, 6.5, math.inf]
# the frequency at which the mesh is tried
TRIED = 2.2
ROUNDING = 1e-12


def words():
    parser = argparse.ArgumentParser(prog="scripts/water", description=__doc__.split("\n")[0])
    parser.add_argument("bridge", type=Path, help="bridge file of equal modules")
    parser.add_argument("out", type=Path, help="path of what is written, without .nc and .json")
    parser.add_argument(
        "--breadth", type=float, help="at the water line [m]; by default what the bridge's stiffness asks for"
    )
    parser.add_argument("--draught", type=float, help="[m]; by default the bridge's draft_m at the module's breadth")
    parser.add_argument("--depth", type=float, default=math.inf, help="of the water [m]; deep by default")
    parser.add_argument("--density", type=float, default=1000.0, help="of the water [kg/m^3]")
    parser.add_argument("--gravity", type=float, default=9.81, help="[m/s^2]")
    parser.add_argument("--modules", type=int, help="another number of modules than the bridge's")
    parser.add_argument("--omega", help="frequencies [rad/s], with commas; 0 and inf are allowed")
    parser.add_argument("--along", type=int, default=8, help="cells along a module, even")
    parser.add_argument("--across", type=int, default=16, help="cells across the hull, even")
    parser.add_argument("--over", type=int, default=1, help="cells over the draught")
    parser.add_argument("--usable-to", type=float, default=5.0, help="frequency up to which the mesh is good [rad/s]")
    parser.add_argument("--no-convergence", action="store_true", help="try no finer mesh")
    return parser.parse_args()


class Hull:
    """A box of equal modules, x from -length / 2."""

    def __init__(self, told):
        bridge = json.loads(told.bridge.read_text())
        module = bridge.get("module")
        if not isinstance(bridge.get("modules"), int) or module is None:
            sys.exit(f"{told.bridge}: modules: a number of equal modules is needed")
        self.modules = told.modules or bridge["modules"]
        self.module_length = module["length_m"]
        weight = told.density * told.gravity
        by_stiffness = module["breadth_m"] * bridge.get("hydrostatic_stiffness_pa_m", weight) / weight
        self.breadth = told.breadth or by_stiffness
        # the displacement stays what the module's breadth and the bridge's draft make it
        draft = bridge.get("draft_m")
        if told.draught is None and draft is None:
            sys.exit(f"{told.bridge}: draft_m: missing, and no --draught is given")
        self.draught = told.draught or draft * module["breadth_m"] / self.breadth
        self.length = self.modules * self.module_length
        if told.depth <= self.draught:
            sys.exit(f"--depth: {told.depth} m, allowed: above the draught of {self.draught:.4g} m")

    def words(self):
        return f"box {self.length:g} x {self.breadth:.4g} x {self.draught:.4g} m"


def mesh(hull, along, across, over):
    """A quarter of the box, reflected twice; no cell crosses a joint, and cells are finer towards the sides."""
    columns = along * hull.modules / 2
    if across % 2 or columns != int(columns):
        sys.exit("--across and --along: even numbers, as the hull is made of mirrored quarters")
    half = hull.length / 2
    x = np.linspace(0, half, int(columns) + 1)
    y = np.linspace(0, 1, across // 2 + 1)
    y = hull.breadth / 2 * (0.65 * y + 0.35 * np.sin(y * math.pi / 2))
    z = np.linspace(-hull.draught, 0, over + 1)
    cells = []
    for a, b in zip(x[:-1], x[1:], strict=True):
        bottom = -hull.draught
        cells += [
            ((a, c, bottom), (a, d, bottom), (b, d, bottom), (b, c, bottom)) for c, d in zip(y[:-1], y[1:], strict=True)
        ]
        cells += [
            ((a, y[-1], c), (a, y[-1], d), (b, y[-1], d), (b, y[-1], c)) for c, d in zip(z[:-1], z[1:], strict=True)
        ]
    for c, d in zip(y[:-1], y[1:], strict=True):
        cells += [((half, c, e), (half, d, e), (half, d, f), (half, c, f)) for e, f in zip(z[:-1], z[1:], strict=True)]
    points = np.array(cells).reshape(-1, 3)
    quarter = cpt.Mesh(vertices=points, faces=np.arange(len(points)).reshape(-1, 4), name="quarter")
    whole = cpt.ReflectionSymmetricMesh(cpt.ReflectionSymmetricMesh(quarter, plane="xOz"), plane="yOz")
    return whole.with_quadrature("Gauss-Legendre 2")


def body(hull, along, across, over):
    """The hull with the motion of each module about (x_c, 0, 0)."""
    made = cpt.FloatingBody(mesh=mesh(hull, along, across, over), name="bridge")
    centres = made.mesh.faces_centers
    from_end = centres[:, 0] + hull.length / 2
    module = np.clip((from_end / hull.module_length).astype(int), 0, hull.modules - 1)
    for m in range(hull.modules):
        on = (module == m).astype(float)
        x, none = from_end - (m + 0.5) * hull.module_length, 0 * on
        made.dofs[f"m{m + 1:02d}__heave"] = np.c_[none, none, on]
        made.dofs[f"m{m + 1:02d}__pitch"] = np.c_[centres[:, 2] * on, none, -x * on]
        made.dofs[f"m{m + 1:02d}__roll"] = np.c_[none, -centres[:, 2] * on, centres[:, 1] * on]
    return made


def problems(told, hull_body, omega, freedoms):
    water = {"water_depth": told.depth, "rho": told.density, "g": told.gravity}
    return [cpt.RadiationProblem(body=hull_body, radiating_dof=name, omega=omega, **water) for name in freedoms]


def solver(told):
    part = "low_freq_with_rankine_part" if math.isinf(told.depth) else "low_freq"
    return cpt.BEMSolver(green_function=cpt.Delhommeau(gf_singularities=part), method="direct")


def heave(told, hull, cells):
    """Added mass [kg/m] and damping [N s/m^2] of the whole bridge's heave, at the frequency that is tried."""
    hull_body = body(hull, *cells)
    names = [name for name in hull_body.dofs if name.endswith("heave")]
    hull_body.dofs = {"heave": sum(hull_body.dofs[name] for name in names)}
    (result,) = solver(told).solve_all(problems(told, hull_body, TRIED, ["heave"]), progress_bar=False)
    return result.added_mass["heave"] / hull.length, result.radiation_damping["heave"] / hull.length


def tell_convergence(told, hull, cells):
    finer = tuple(max(cell + 1, 2 * round(0.75 * cell)) for cell in cells)
    finer = (finer[0], finer[1] + finer[1] % 2, cells[2])
    ours, theirs = heave(told, hull, cells), heave(told, hull, finer)
    off = [100 * (a / b - 1) for a, b in zip(ours, theirs, strict=True)]
    print(
        f"mesh at {TRIED} rad/s, whole heave per metre: {cells} cells {ours[0]:.0f} kg, {ours[1]:.0f} N s/m;", end=" "
    )
    print(f"{finer} cells {theirs[0]:.0f} kg, {theirs[1]:.0f} N s/m: {off[0]:+.1f} %, {off[1]:+.1f} %", flush=True)
    return off


def solve(told, hull, cells, omegas):
    """A dataset over frequency; one without numbers is left out."""
    hull_body, results, left_out = body(hull, *cells), [], []
    by = solver(told)
    for omega in omegas:
        begin = time.monotonic()
        solved = by.solve_all(problems(told, hull_body, omega, hull_body.dofs), progress_bar=False)
        if all(np.isfinite(list(result.added_mass.values())).all() for result in solved):
            results += solved
        else:
            left_out.append(omega)
        print(f"{omega:6.3f} rad/s: {hull_body.mesh.nb_faces} cells, {time.monotonic() - begin:.1f} s", flush=True)
    if left_out:
        print(f"left out, no numbers: {', '.join(f'{omega:g}' for omega in left_out)} rad/s")
    return cpt.assemble_dataset(results)


def triangle(matrix):
    """The upper triangle of the symmetric part, row by row, at 7 significant digits."""
    matrix = (matrix + matrix.T) / 2
    matrix[abs(matrix) <= ROUNDING * abs(matrix).max()] = 0
    return [number(float(f"{entry:.6e}")) for entry in matrix[np.triu_indices(len(matrix))]]


def number(x):
    return int(x) if x == int(x) else x


def asymmetry(matrices, scale):
    scaled = matrices / scale[:, None] / scale[None, :]
    difference, largest = abs(scaled - scaled.transpose(0, 2, 1)).max((1, 2)), abs(scaled).max((1, 2))
    return float((difference / np.maximum(largest, 1e-300)).max(initial=0))


def water_file(told, hull, data, netcdf, note):
    """The neutral form of a dataset."""
    names = [f"m{m + 1:02d}__{freedom}" for m in range(hull.modules) for freedom in FREEDOMS]
    data = data.sel(influenced_dof=names, radiating_dof=names).sortby("omega")
    data = data.transpose("omega", "influenced_dof", "radiating_dof", ...)
    omega, mass, damping = (data[name].values for name in ("omega", "added_mass", "radiation_damping"))
    finite = np.isfinite(omega)
    used = finite & (omega > 0) & (omega <= told.usable_to)
    scale = np.tile([1, hull.module_length / 12**0.5, hull.breadth / 12**0.5], hull.modules)
    return {
        "name": told.out.name,
        "source": {
            "program": "Capytaine",
            "version": cpt.__version__,
            "file": netcdf.name,
            "blake3": blake3.blake3(netcdf.read_bytes()).hexdigest(),
            "note": note,
            "asymmetry": {
                "added_mass": float(f"{asymmetry(mass[used], scale):.3e}"),
                "radiation_damping": float(f"{asymmetry(damping[used], scale):.3e}"),
            },
        },
        "modules": hull.modules,
        "module_length_m": hull.module_length,
        "depth_m": None if math.isinf(told.depth) else told.depth,
        "density_kg_m3": told.density,
        "gravity_m_s2": told.gravity,
        "hull": hull.words(),
        "waterline_breadth_m": hull.breadth,
        "draught_m": hull.draught,
        "freedoms": list(FREEDOMS),
        "usable_to_rad_s": told.usable_to,
        "omega_rad_s": [number(float(w)) for w in omega[finite]],
        "added_mass": [triangle(matrix) for matrix in mass[finite]],
        "radiation_damping": [triangle(matrix) for matrix in damping[finite]],
        "infinite_added_mass": triangle(mass[~finite][0]) if not finite.all() else None,
    }


def main():
    told = words()
    logging.disable(logging.WARNING)
    hull = Hull(told)
    cells = (told.along, told.across, told.over)
    omegas = [float(word) for word in told.omega.split(",")] if told.omega else OMEGA
    print(f"{hull.words()}, {hull.modules} modules, {'deep' if math.isinf(told.depth) else f'{told.depth:g} m deep'}")
    note = f"cells a module along, across, over the draught: {', '.join(map(str, cells))}; 2 x 2 Gauss points a cell"
    if not told.no_convergence:
        off = tell_convergence(told, hull, cells)
        note += f"; at {TRIED} rad/s {off[0]:+.1f} % of added mass, {off[1]:+.1f} % of damping beside a finer mesh"
    data = solve(told, hull, cells, omegas)
    for name in list(data.coords):
        # what netCDF cannot hold
        if data[name].dtype == object and name not in data.dims:
            data = data.drop_vars(name)
    data.attrs |= {
        "name": told.out.name,
        "hull": hull.words(),
        "module_length_m": hull.module_length,
        "waterline_breadth_m": hull.breadth,
        "draught_m": hull.draught,
    }
    netcdf = told.out.with_name(told.out.name + ".nc")
    cpt.export_dataset(netcdf, data, format="netcdf")
    file = told.out.with_name(told.out.name + ".json")
    file.write_text(json.dumps(water_file(told, hull, data, netcdf, note), separators=(",", ":")) + "\n")
    print(f"{netcdf}, {file}")


if __name__ == "__main__":
    main()
