"""Holds what `pontoon export` wrote, read by meshio, against the tables of the same jobs. Called by check-export."""

import json
import pathlib
import sys
import xml.etree.ElementTree as ElementTree
from itertools import pairwise

import meshio
import numpy as np
import polars as pl

SINGLE = 2.0**-23  # displacements are written in single precision
OPERATOR = 0.005  # what the operator promises of deflections
PLATES = {"deck": 0, "bottom": 1, "side": 2, "end wall": 3, "longitudinal wall": 4, "transverse wall": 5}

wrong = sys.argv[sys.argv.index("--wrong") + 1] if "--wrong" in sys.argv else None
checks = 0


def hold(what, good):
    global checks
    checks += 1
    if not good:
        raise SystemExit(f"falls short: {what}")


def near(what, found, expected, tolerance):
    found, expected = np.asarray(found, float), np.asarray(expected, float)
    off = np.max(np.abs(found - expected), initial=0.0)
    hold(f"{what}: off by {off:.3e}, allowed {tolerance:.3e}", found.shape == expected.shape and off <= tolerance)


def write_studies(out):
    """The smoke study by both solvers, with a moving mass averaged over the patch, and static cases on its bridge."""
    smoke = json.loads(pathlib.Path("studies/smoke/study.json").read_text())
    bridge = json.loads(pathlib.Path("studies/bridges/smoke.json").read_text())
    (out / "bridge.json").write_text(json.dumps(bridge))
    crossing = {"gap_compression_m": 0.0055, "speed_m_s": 10, "load_n": 150000}
    nonlinear = [{**crossing, "gap_tension_m": gap} for gap in (0.028, 0.0)]
    linear = {**crossing, "connection": "linear"}
    static = [{"load_n": 1e5, "load_position": 2}, {"load_n": 1e5, "load_x_m": 9.0, "connection": "linear"}]
    record = {"histories": {"positions": [1, 2, 3, 4], "joints": [2, 3]}}

    def study(name, cases, analysis, **more):
        document = {**smoke, "name": name, "bridge": "../bridge.json", "design": [{"cases": cases}], **more}
        document["analysis"] = analysis
        (out / name).mkdir()
        (out / name / "study.json").write_text(json.dumps(document))

    moving = {"kind": "crossing", "time_step_s": 0.02, "tail_s": 1.0}
    study("operator", nonlinear + [linear], moving, record=record)
    study("reference", [nonlinear[1], linear], {**moving, "solver": "reference"}, record=record)
    vehicle = {
        "axles": [
            {
                "behind_front_m": 0.0,
                "share": 0.4,
                "patch_length_m": 0.3,
                "patch_width_m": 0.4,
                "track_y_m": [-1.4, 1.4],
            },
            {"behind_front_m": 4.2, "share": 0.6, "patch_length_m": 0.3, "track_y_m": [0.5]},
        ],
        "inertia": "convective",
    }
    study("inertia", nonlinear[:1], {**moving, "solver": "reference"}, vehicle=vehicle, record=record)
    study("static", static, {"kind": "static"}, record={})


class Grid:
    """A file as meshio reads it, cells of all kinds in one list."""

    def __init__(self, path):
        mesh = meshio.read(path)
        self.points = np.asarray(mesh.points, float)
        self.cells = [(block.type, block.data) for block in mesh.cells]
        self.point = {name: np.asarray(array, float) for name, array in mesh.point_data.items()}
        self.cell = {name: np.concatenate(arrays) for name, arrays in mesh.cell_data.items()}
        self.field = {}
        for name, array in mesh.field_data.items():
            self.field[name] = bytes(array).decode() if array.dtype == np.uint8 else array[0]
        for arrays in (self.point, self.cell):
            # a mode has no size of its own: its twin would say nothing of the tables
            if wrong in arrays and "time_s" in self.field:
                arrays[wrong] = 1.05 * arrays[wrong]
        if wrong == "vehicle_displacement" and "contact_force_n" in self.point:
            self.point["displacement"] = 1.05 * self.point["displacement"]
        count = sum(len(data) for _, data in self.cells)
        for _, data in self.cells:
            hold(
                f"{path}: cells of points that are there",
                data.size == 0 or 0 <= data.min() <= data.max() < len(self.points),
            )
        for name, array in self.point.items():
            hold(
                f"{path}: {name} an entry a point, finite", len(array) == len(self.points) and np.isfinite(array).all()
            )
        for name, array in self.cell.items():
            hold(f"{path}: {name} an entry a cell, finite", len(array) == count and np.isfinite(array).all())
        hold(f"{path}: the program's version", len(self.field["program_version"].split(".")) == 3)


class Export:
    """A folder, read whole."""

    def __init__(self, folder):
        self.folder = folder
        self.contents = json.loads((folder / "export.json").read_text())
        found = sorted(path.name for path in folder.iterdir())
        hold(f"{folder}: the files that it names, and no others", found == self.contents["files"])
        named = {"export.json"}
        self.series = {}
        for part in self.contents["parts"]:
            name = part["file"]
            steps = [
                (float(d.get("timestep")), d.get("file")) for d in ElementTree.parse(folder / name).iter("DataSet")
            ]
            hold(f"{name}: its instants", len(steps) == part["instants"])
            hold(f"{name}: in order", all(a[0] < b[0] for a, b in pairwise(steps)))
            grids = [(time, Grid(folder / file)) for time, file in steps]
            first = grids[0][1]
            hold(f"{name}: points", len(first.points) == part["points"])
            hold(f"{name}: cells", sum(len(data) for _, data in first.cells) == part["cells"])
            for time, grid in grids:
                hold(f"{name}: the time of a file is that of the series", grid.field.get("time_s", time) == time)
            named |= {name, *(file for _, file in steps)}
            self.series[name.removesuffix(".pvd")] = grids
        hold(f"{folder}: every file belongs to a series", named == set(found))


def check_mesh(grid, bridge):
    """Plates have the areas of the box, in every module, at the thickness of the design."""
    design, modules = bridge["module"], bridge["modules"]
    kinds = [kind for kind, data in grid.cells for _ in range(len(data))]
    quads = np.concatenate([data for kind, data in grid.cells if kind == "quad"])
    a, b, c, d = (grid.points[quads[:, i]] for i in range(4))
    area = 0.5 * np.linalg.norm(np.cross(c - a, d - b), axis=1)
    plate = grid.cell["plate"][: len(quads)]
    long, broad, deep = design["length_m"], design["breadth_m"], design["depth_m"]
    walls = [len(design[key][at]) for key, at in (("longitudinal_walls", "y_m"), ("transverse_walls", "x_m"))]
    for name, expected, thickness in [
        ("deck", long * broad, design["deck_thickness_m"]),
        ("bottom", long * broad, design["bottom_thickness_m"]),
        ("side", 2 * long * deep, design["side_thickness_m"]),
        ("end wall", 2 * broad * deep, design["end_thickness_m"]),
        ("longitudinal wall", walls[0] * long * deep, design["longitudinal_walls"]["thickness_m"]),
        ("transverse wall", walls[1] * broad * deep, design["transverse_walls"]["thickness_m"]),
    ]:
        own = plate == PLATES[name]
        near(f"area of {name}", area[own].sum(), modules * expected, 1e-5 * modules * expected)
        near(f"thickness of {name}", grid.cell["thickness_m"][: len(quads)][own], np.full(own.sum(), thickness), 0.0)
    hold(
        "beams are lines", all((kind == "line") == (p == 7) for kind, p in zip(kinds, grid.cell["plate"], strict=True))
    )
    hold("modules", set(grid.cell["module"]) == set(range(1, modules + 1)))


def check_stresses(grid, bridge):
    """Membrane stress and axial force are those of the motion, von Mises stress that of membrane and bending."""
    design = bridge["module"]
    e, nu = design["material"]["youngs_modulus_pa"], design["material"]["poissons_ratio"]
    quads, lines = (np.concatenate([d for kind, d in grid.cells if kind == of]) for of in ("quad", "line"))
    moved, cell = grid.point["displacement"].astype(float), grid.cell
    corners, u = grid.points[quads], moved[quads]

    def gradient(ends, begins):
        """Of the motion between the middles of two sides, and its axis."""
        apart, change = (0.5 * (x[:, ends].sum(axis=1) - x[:, begins].sum(axis=1)) for x in (corners, u))
        length = np.linalg.norm(apart, axis=1, keepdims=True)
        return change / length, apart / length

    (along, one), (across, two) = gradient([1, 2], [0, 3]), gradient([2, 3], [0, 1])
    e_1, e_2 = (along * one).sum(axis=1), (across * two).sum(axis=1)
    g = (along * two).sum(axis=1) + (across * one).sum(axis=1)
    c = e / (1 - nu**2)
    membrane = np.stack([c * (e_1 + nu * e_2), c * (e_2 + nu * e_1), e / 2 / (1 + nu) * g])
    shells = slice(0, len(quads))
    found, bending = (
        np.stack([cell[f"{of}_{ij}_pa"][shells] for ij in (11, 22, 12)]) for of in ("membrane", "bending")
    )
    # single precision of displacements on elements half a metre long
    near("membrane stress", found, membrane, 1e-4 * np.abs(membrane).max())

    def von_mises(s):
        tensor = np.zeros((s.shape[1], 3, 3))
        tensor[:, 0, 0], tensor[:, 1, 1] = s[0], s[1]
        tensor[:, 0, 1] = tensor[:, 1, 0] = s[2]
        deviator = tensor - np.trace(tensor, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
        return np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2)))

    sides = von_mises(found.astype(float) + bending), von_mises(found.astype(float) - bending)
    size = np.max(sides)
    for name, expected in [("top_", sides[0]), ("bottom_", sides[1]), ("", np.maximum(*sides))]:
        near(f"von Mises stress {name}", cell[f"von_mises_{name}pa"][shells], expected, 4 * SINGLE * size)
    axis = np.diff(grid.points[lines], axis=1)[:, 0]
    length = np.linalg.norm(axis, axis=1)
    longer = (np.diff(moved[lines], axis=1)[:, 0] * axis).sum(axis=1) / length
    force = e * design["stiffeners"]["area_m2"] * longer / length
    near("axial force of stiffeners", cell["axial_force_n"][len(quads) :], force, 1e-4 * np.abs(force).max())


def check_envelope(export):
    """The largest von Mises stress of all steps, all of which are shown, at a time at which it is reached."""
    [(_, envelope)], mesh = export.series["crossing-envelope"], export.series["crossing"]
    times = np.array([time for time, _ in mesh])
    shown = np.stack([grid.cell["von_mises_pa"] for _, grid in mesh])
    most, time = envelope.cell["von_mises_pa"], envelope.cell["von_mises_time_s"]
    near("envelope of von Mises stress", most, shown.max(axis=0), 0.0)
    shells = np.flatnonzero(most)
    step = np.searchsorted(times, time[shells])
    near("times of the envelope", times[step], time[shells], 0.0)
    near("stress at the times of the envelope", shown[step, shells], most[shells], 0.0)


def deflection_m(grid, x_m):
    """Of the bottom's centre line; of the two sides of a joint, which are hinged there, either."""
    place = np.array([x_m, 0.0, 0.0])
    node = np.argmin(np.linalg.norm(grid.points - place, axis=1))
    near("a node on the bottom's centre line", grid.points[node], place, 1e-4)
    return -grid.point["displacement"][node, 2]


def check_joints(grid, bridge, axes):
    """States are those of the forces, forces those of the elongations, elongations those of the ends."""
    cell, k = grid.cell, bridge["connectors"]["stiffness_n_m"]
    connector = cell["link"] == 0
    force, state, e = cell["force_n"], cell["state"], cell["elongation_m"]
    hold("states 0, 1, 2 are none, negative and positive forces", (np.sign(force) == np.array([0, -1, 1])[state]).all())
    if axes["connection"] == "linear":
        expected = 2 * k * e
    else:
        pull, push = axes["gap_tension_m"], axes["gap_compression_m"]
        expected = k * (np.maximum(e - pull, 0) + np.minimum(e + push, 0))
    size = np.abs(force).max(initial=1e-6)
    near("forces on the left, along", cell["force_on_left_n"][:, 0], force, SINGLE * size)
    across = cell["force_on_left_n"][connector, 1:]
    near("connectors act along alone", across, np.zeros_like(across), 0.0)
    near("connector law", force[connector], expected[connector], 1e-6 * k * 1e-3)
    ends = grid.point["displacement"].reshape(-1, 2, 3)
    moved = ends[:, 1, 0] - ends[:, 0, 0]
    size = np.abs(ends).max(initial=1e-6)
    near("elongations", moved[connector], e[connector], 4 * SINGLE * size)
    near("hinges are tied", ends[~connector, 1], ends[~connector, 0], 0.0)


def deck_displacement(mesh, x, y):
    """Of a point of the deck, bilinear between the corners of its plate; where plates of two modules meet, of each."""
    quads = np.concatenate([data for kind, data in mesh.cells if kind == "quad"])
    quads = quads[mesh.cell["plate"][: len(quads)] == PLATES["deck"]]
    corners, slack = mesh.points[quads][:, :, :2], 1e-5
    low, high = corners.min(axis=1), corners.max(axis=1)
    there = ((low - slack <= [x, y]) & ([x, y] <= high + slack)).all(axis=1)
    for quad, at, size in zip(quads[there], corners[there], (high - low)[there], strict=True):
        parts = (1 - np.abs(at - [x, y]) / size).prod(axis=1)
        yield parts @ mesh.point["displacement"][quad]


def check_vehicle(grid, mesh, bridge, load_n, x_of_front):
    length = bridge["modules"] * bridge["module"]["length_m"]
    x, on = grid.points[:, 0], grid.point["on_bridge"] == 1
    near("who is on the bridge", on, (x >= -1e-5) & (x <= length + 1e-5), 0.0)
    hold("no force off the bridge", (grid.point["contact_force_n"][~on] == 0).all())
    hold("points on the deck", np.allclose(grid.points[:, 2], bridge["module"]["depth_m"], atol=1e-6))
    moved = grid.point["displacement"]
    hold("no motion off the bridge", (moved[~on] == 0).all())
    # places are in single precision: some 1e-6 m of plates 1 m long
    tolerance = 1e-5 * np.abs(mesh.point["displacement"]).max()
    for (x_m, y_m, _), own in zip(grid.points[on], moved[on], strict=True):
        off = min(np.abs(own - deck).max() for deck in deck_displacement(mesh, x_m, y_m))
        near("the vehicle moves with the deck under it", off, 0.0, tolerance)
    if x_of_front is not None:
        # half a footprint ahead of the front at most: 3.35 m and 8 points; axles of 0.3 m
        hold("the vehicle is where its time says", -1e-4 <= x_of_front + 1.675 - x.max() <= 1.675)
    return grid.point["contact_force_n"].sum(), on.all()


def column(table, name, **keys):
    for key, value in keys.items():
        table = table.filter(pl.col(key).is_null() if value is None else pl.col(key) == value)
    return table[name].to_list()


def settled(x, bridge, speed_m_s):
    """Whether all points have been on their modules for 50 ms, from when on their axle's contact force counts."""
    length, last = bridge["module"]["length_m"], bridge["modules"] - 1
    on_module = x - length * np.minimum(np.floor(x / length), last)
    return (on_module >= 0.05 * speed_m_s).all()


def bridge_of(results):
    """The bridge of a run, which stands in a document beside its manifest."""
    documents = json.loads((results / "manifest.json").read_text())["documents"]
    return json.loads((results / documents["bridge"]["file"]).read_text())


def check_crossing(export, results, exact):
    job = export.contents["source"]["job"]
    bridge, jobs = bridge_of(results), pl.read_parquet(results / "jobs.parquet")
    axes = jobs.filter(pl.col("job") == job).to_dicts()[0]
    mesh, joints, vehicle = (export.series[name] for name in ("crossing", "crossing-joints", "crossing-vehicle"))
    times = np.array([time for time, _ in mesh])
    hold("three series of the same times", all([t for t, _ in s] == times.tolist() for s in (joints, vehicle)))
    hold("every step", len(times) == axes["steps"] + 1)
    check_mesh(mesh[0][1], bridge)
    peak = axes["peak_deflection_m"]
    tolerance = 4 * SINGLE * peak if exact else OPERATOR * peak
    for row in pl.read_parquet(results / "positions.parquet").filter(pl.col("job") == job).to_dicts():
        if row["peak_deflection_time_s"] is not None:
            nearest = np.argmin(np.abs(times - row["peak_deflection_time_s"]))
            near("a step at the peak's time", times[nearest], row["peak_deflection_time_s"], 1e-9)
            found = deflection_m(mesh[nearest][1], row["x_m"])
            near(f"deflection of position {row['position']}", found, row["peak_deflection_m"], tolerance)
    near(
        "the folder's own peak",
        export.series and max(p.get("peak_deflection_m", 0) for p in export.contents["parts"]),
        peak,
        tolerance,
    )
    histories = pl.read_parquet(results / "histories.parquet").filter(pl.col("job") == job)
    for position in (1, 2, 3, 4):
        values = column(histories, "value", quantity="deflection_m", position=position)
        found = [deflection_m(grid, (position - 1) * bridge["module"]["length_m"]) for _, grid in mesh]
        near(f"history of position {position}", found, values, tolerance)
    most = max(axes["peak_compression_n"], axes["peak_tension_n"])
    for joint in (2, 3):
        values = np.array(column(histories, "value", quantity="force_n", position=joint))
        own = [(grid.cell["joint"] == joint) & (grid.cell["link"] == 0) for _, grid in joints]
        found = np.array([grid.cell["force_n"][o].sum() for (_, grid), o in zip(joints, own, strict=True)])
        if exact:
            near(f"history of joint {joint}", found, values, 1e-9 * most)
            senses = [set(grid.cell["state"][o]) for (_, grid), o in zip(joints, own, strict=True)]
            hold(
                f"states of joint {joint}",
                all(
                    (v == 0) == (s == {0}) or axes["connection"] == "linear"
                    for v, s in zip(values, senses, strict=True)
                ),
            )
            hold(
                f"senses of joint {joint}",
                all((1 in s or v >= 0) and (2 in s or v <= 0) for v, s in zip(values, senses, strict=True)),
            )
        else:
            # contacts decide within a step: 2 % of the largest force is what the operator promises
            near(f"peak of joint {joint}", [found.max(), found.min()], [values.max(), values.min()], 0.02 * most)
    smallest = np.inf
    for (time, grid), (_, joint), (_, under) in zip(vehicle, joints, mesh, strict=True):
        check_joints(joint, bridge, axes)
        force, whole = check_vehicle(grid, under, bridge, axes["load_n"], axes["speed_m_s"] * time)
        for axle in set(grid.point["axle"]):
            own = grid.point["axle"] == axle
            if grid.point["on_bridge"][own].all() and settled(grid.points[own, 0], bridge, axes["speed_m_s"]):
                smallest = min(smallest, grid.point["contact_force_n"][own].sum())
    if exact:
        near("smallest contact force", smallest, axes["min_contact_force_n"], 1e-9 * axes["load_n"])


def check_static(export, results):
    job = export.contents["source"]["job"]
    bridge = bridge_of(results)
    axes = pl.read_parquet(results / "jobs.parquet").filter(pl.col("job") == job).to_dicts()[0]
    mesh, joints, vehicle = (export.series[name][0][1] for name in ("static", "static-joints", "static-vehicle"))
    check_mesh(mesh, bridge)
    check_stresses(mesh, bridge)
    for row in pl.read_parquet(results / "positions.parquet").filter(pl.col("job") == job).to_dicts():
        found = deflection_m(mesh, row["x_m"])
        near(
            f"deflection of position {row['position']}",
            found,
            row["deflection_m"],
            4 * SINGLE * axes["peak_deflection_m"],
        )
    forces = pl.read_parquet(results / "connectors.parquet").filter(pl.col("job") == job)
    most = max(axes["peak_compression_n"], axes["peak_tension_n"])
    for row in forces.filter(pl.col("y_m").is_not_null()).to_dicts():
        own = (joints.cell["joint"] == row["joint"]) & (joints.cell["y_m"] == row["y_m"]) & (joints.cell["link"] == 0)
        expected = row["peak_tension_n"] - row["peak_compression_n"]
        near(f"force of joint {row['joint']}", joints.cell["force_n"][own], [expected], 1e-9 * most)
    for joint in (2, 3):
        own = joints.cell["joint"] == joint
        near(f"hinges and connectors of joint {joint} balance", joints.cell["force_n"][own].sum(), 0.0, 1e-9 * most)
    check_joints(joints, bridge, axes)
    force, whole = check_vehicle(vehicle, mesh, bridge, axes["load_n"], None)
    near("the vehicle's weight", force, axes["load_n"], 1e-9 * axes["load_n"])
    hold("the vehicle on the bridge", whole)


def check_modes(export, expected, bridge):
    grids = export.series["modes"]
    hold("as many modes", len(grids) == len(expected))
    check_mesh(grids[0][1], bridge)
    for (number, grid), mode in zip(grids, expected, strict=True):
        hold(
            f"name of mode {number}",
            grid.field["shape"] == mode["shape"] and number == mode["number"] == grid.field["number"],
        )
        near(f"frequency of mode {number}", grid.field["frequency_hz"], mode["frequency_hz"], 1e-9)
        near(f"largest component of mode {number}", grid.point["displacement"].max(), 1.0, SINGLE)
        hold(f"no component of mode {number} is larger", np.abs(grid.point["displacement"]).max() <= 1.0 + SINGLE)


def check(out):
    bridge = json.loads((out / "bridge.json").read_text())
    modes = json.loads((out / "modes.json").read_text())
    of_bridge = Export(out / "vtk/bridge")
    check_modes(of_bridge, modes, bridge)
    operator = Export(out / "vtk/operator")
    check_modes(operator, modes, bridge)
    check_crossing(operator, out / "results/operator", exact=False)
    table = pl.read_parquet(out / "results/operator/jobs.parquet")
    worst = table.sort("peak_deflection_m", descending=True)["job"][0]
    hold("the job with the largest deflection", operator.contents["source"]["job"] == worst)
    for name in ("reference-0", "reference-1"):
        check_crossing(Export(out / "vtk" / name), out / "results/reference", exact=True)
    inertia = Export(out / "vtk/inertia")
    check_crossing(inertia, out / "results/inertia", exact=True)
    check_envelope(inertia)
    for name in ("static-0", "static-1"):
        check_static(Export(out / "vtk" / name), out / "results/static")
    # the bridge file's own static case is the study's first
    ours, study = (Export(out / "vtk" / name).series["static"][0][1] for name in ("bridge", "static-0"))
    near("a bridge file's static case", ours.point["displacement"], study.point["displacement"], 0.0)
    print(f"{checks} checks of what meshio reads hold")


folder = pathlib.Path(sys.argv[2])
if sys.argv[1] == "studies":
    write_studies(folder)
else:
    check(folder)
