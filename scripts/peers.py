"""Prints pontoon beside OpenSees: modes and static cases of a bridge, crossings of a plane chain. See scripts/peers.

Knows bridge files, the chain's file, and how both are built from OpenSeesPy elements: mesh, water, ties and loads are
made here, elements and time integration are OpenSees' own. Of pontoon it reads printed frequencies and tables, no mesh
and no matrix.

OpenSees offers several shells. ASDShellQ4 is the peer: its in-plane stiffness is pontoon's but for drilling, which it
resists by 0.28 G t where pontoon does by G t. That is what raises pontoon's torsion by half a percent on the file's
mesh; refinement takes it away. `--shell` runs others: ShellMITC4's bilinear membrane locks in in-plane bending (2 % in
torsion and horizontal bending), ShellDKGQ has another membrane with next to no stiffness against drilling.

No mesh may be much finer than the refined one: three elements and more across a panel of the bottom let it swing by
itself with the water's mass, near 4 Hz, and the bridge's higher modes fall with it. ShellDKGQ, of cubic deflection,
does so with two.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from itertools import pairwise
from pathlib import Path

import numpy as np
import openseespy.opensees as ops
import polars as pl

ROOT = Path(__file__).resolve().parent.parent
BRIDGE = ROOT / "studies/bridges/fu2005.json"
CHAIN = ROOT / "tests/data/chain.json"
REFINED = {"elements_along": 16, "elements_between_lines": 2, "elements_over_depth": 4}
NAMED = [f"vertical bending {n}" for n in range(1, 10)]
NAMED += [f"torsion {n}" for n in range(1, 4)] + [f"horizontal bending {n}" for n in range(1, 3)]
LOAD_N, FOOTPRINT_M, TRACK_Y_M, FOOTPRINT_POINTS, LOAD_POSITION = 230300.0, 3.35, [-1.4, 1.4], 8, 7
SAME_PLACE_M = 1e-6
# springs in x and y against drift of the bridge that floats free, per mass [1/s^2]: 0.005 Hz
DRIFT_1_S2 = 1e-3
# half of it moves no judged peak by more than 0.1 %
CHAIN_TIME_STEP_S = 0.0025
X, Y, Z = 1, 2, 3


# ---- the table


class Table:
    """Rows of both codes, and the names of those whose deviation is beyond what is asked."""

    def __init__(self):
        self.beyond = []
        self.title = ""

    def head(self, title, pontoon_s, opensees_s):
        """Begins a block; the wall times of the two sides."""
        self.title = title
        print(f"\n{title}   [pontoon {pontoon_s:.1f} s, OpenSees {opensees_s:.1f} s]")
        print(f"{'':48} {'pontoon':>11} {'OpenSees':>11} {'deviation':>11} {'asked':>6}")

    def row(self, name, unit, pontoon, opensees, asked_percent=None, of=None):
        """Deviation of pontoon in percent of OpenSees' value, or of `of` where a value may be next to nothing."""
        deviation = 100.0 * (pontoon - opensees) / (opensees if of is None else of)
        verdict, asked = "", ""
        if asked_percent is not None:
            asked = f"{asked_percent:g} %"
            verdict = "ok" if abs(deviation) <= asked_percent else "BEYOND"
            if verdict == "BEYOND":
                self.beyond.append(f"{self.title}: {name} {deviation:+.2f} %")
        values = f"{pontoon:11.5g} {opensees:11.5g} {deviation:+9.2f} %"
        print(f"{name + f' [{unit}]':48} {values} {asked:>6} {verdict}".rstrip(), flush=True)


# ---- the program's side


def pontoon(*words):
    """Standard output of the program."""
    return subprocess.run([os.environ["PONTOON"], *map(str, words)], check=True, stdout=subprocess.PIPE).stdout


def timed(function, *arguments):
    """The function's value and its wall time [s]."""
    start = time.perf_counter()
    value = function(*arguments)
    return value, time.perf_counter() - start


def pontoon_modes(bridge, *words):
    """Frequencies [Hz] by the names of their shapes."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bridge.json"
        path.write_text(json.dumps(bridge))
        return {m["shape"]: m["frequency_hz"] for m in json.loads(pontoon("modes", path, *words, "--format", "json"))}


def pontoon_statics(bridge, connection):
    """Deflections of the positions [m] and forces of the joints [N]."""
    case = {"connection": connection, "load_position": LOAD_POSITION, "load_n": LOAD_N}
    if connection == "nonlinear":
        case |= {key: bridge["connectors"][key] for key in ("gap_tension_m", "gap_compression_m")}
    vehicle = {"footprint_length_m": FOOTPRINT_M, "track_y_m": TRACK_Y_M, "patch_points": FOOTPRINT_POINTS}
    analysis = {"kind": "static", "model": "full"}
    study = {
        "name": "peers",
        "bridge": "bridge.json",
        "vehicle": vehicle,
        "analysis": analysis,
        "design": [{"cases": [case]}],
    }
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "bridge.json").write_text(json.dumps(bridge))
        (folder / "study.json").write_text(json.dumps(study))
        pontoon("run", folder / "study.json", "--out", folder / "out", "--quiet")
        positions = pl.read_parquet(folder / "out/positions.parquet").sort("position")
        joints = pl.read_parquet(folder / "out/connectors.parquet").filter(pl.col("y_m").is_null()).sort("joint")
    force = joints["peak_tension_n"].fill_null(0.0) - joints["peak_compression_n"].fill_null(0.0)
    return positions["deflection_m"].to_numpy(), force.to_numpy()


def pontoon_chain(scenario):
    """The answer to a scenario of the chain."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scenario.json"
        path.write_text(json.dumps(scenario))
        words = [os.environ["PONTOON_CHAIN"], path, str(CHAIN_TIME_STEP_S)]
        return json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE).stdout)


# ---- the bridge in OpenSees


def divided(places, parts):
    """Sorted places, each interval divided into `parts(length)`."""
    places = sorted(places)
    places = [p for i, p in enumerate(places) if i == 0 or p - places[i - 1] > SAME_PLACE_M]
    lines = [places[0]]
    for a, b in pairwise(places):
        lines.extend(np.linspace(a, b, parts(b - a) + 1)[1:])
    return np.array(lines)


def line_at(lines, place):
    """Number of the line at a place."""
    return int(np.argmin(np.abs(lines - place)))


def tributary(lines):
    """Half of each neighbouring interval, for each line."""
    half = np.diff(lines) / 2
    return np.append(half, 0.0) + np.insert(half, 0, 0.0)


class ModuleMesh:
    """Lines of a module and what lies between them, by (ix, iy, iz): shells with their thickness, and beams."""

    def __init__(self, bridge):
        box = bridge["module"]
        stiffeners, mesh = box["stiffeners"], box["mesh"]
        long_walls, cross_walls = box["longitudinal_walls"], box["transverse_walls"]
        half, length = box["breadth_m"] / 2, box["length_m"]
        self.x = divided(
            [0.0, length, *cross_walls["x_m"], *stiffeners["transverse_x_m"]],
            lambda part: int(np.ceil(part * mesh["elements_along"] / length - 1e-6)),
        )
        self.y = divided(
            [
                -half,
                half,
                0.0,
                *long_walls["y_m"],
                *stiffeners["longitudinal_y_m"],
                *bridge["hinges"]["y_m"],
                *bridge["connectors"]["y_m"],
            ],
            lambda _: mesh["elements_between_lines"],
        )
        self.z = np.linspace(0.0, box["depth_m"], mesh["elements_over_depth"] + 1)
        self.last = tuple(len(lines) - 1 for lines in (self.x, self.y, self.z))
        nx, ny, nz = self.last
        self.shells = []
        self._plates(2, {0: box["bottom_thickness_m"], nz: box["deck_thickness_m"]})
        sides = {0: box["side_thickness_m"], ny: box["side_thickness_m"]}
        self._plates(1, sides | {line_at(self.y, y): long_walls["thickness_m"] for y in long_walls["y_m"]})
        ends = {0: box["end_thickness_m"], nx: box["end_thickness_m"]}
        self._plates(0, ends | {line_at(self.x, x): cross_walls["thickness_m"] for x in cross_walls["x_m"]})
        across = [line_at(self.x, x) for x in stiffeners["transverse_x_m"]]
        along = [line_at(self.y, y) for y in stiffeners["longitudinal_y_m"]]
        self.beams = []
        for iz in (0, nz):
            self.beams += [((ix, iy, iz), (ix, iy + 1, iz)) for ix in across for iy in range(ny)]
            self.beams += [((ix, iy, iz), (ix + 1, iy, iz)) for iy in along for ix in range(nx)]
        posts = {(ix, iy) for ix in across for iy in (0, ny)} | {(ix, iy) for iy in along for ix in (0, nx)}
        self.beams += [((ix, iy, iz), (ix, iy, iz + 1)) for ix, iy in sorted(posts) for iz in range(nz)]
        self.nodes = sorted({corner for _, corners in self.shells for corner in corners})

    def _plates(self, normal, thickness_at):
        """Plates across the axis `normal`, at its lines."""
        a, b = (axis for axis in range(3) if axis != normal)
        for line, thickness in thickness_at.items():
            for i, j in np.ndindex(self.last[a], self.last[b]):
                corners = []
                for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    corner = [line, line, line]
                    corner[a], corner[b] = i + di, j + dj
                    corners.append(tuple(corner))
                self.shells.append((thickness, corners))


class BridgePeer:
    """A bridge in OpenSees' domain, which is wiped before; `tag(module, (ix, iy, iz))` is a node."""

    def __init__(self, bridge, shell, modules, floating, connection="linear"):
        self.bridge, self.mesh, self.modules = bridge, ModuleMesh(bridge), modules
        self.number = {place: n for n, place in enumerate(self.mesh.nodes, 1)}
        self.elements = self.materials = 0
        self.connectors = []
        ops.wipe()
        ops.model("basic", "-ndm", 3, "-ndf", 6)
        self._sections()
        for module in range(modules):
            self._structure(module, shell)
            self._water(module, floating)
            if module:
                self._joint(module, connection)
        if not floating:
            self._supports()
        ops.constraints("Transformation")
        ops.numberer("RCM")
        # SparseSYM gives wrong eigenvalues, UmfPack takes twice the time
        ops.system("SuperLU")

    def tag(self, module, place):
        """Number of a node."""
        return module * len(self.number) + self.number[place]

    def _element(self, kind, *arguments):
        self.elements += 1
        ops.element(kind, self.elements, *arguments)
        return self.elements

    def _material(self, kind, *arguments):
        self.materials += 1
        ops.uniaxialMaterial(kind, self.materials, *arguments)
        return self.materials

    def _sections(self):
        steel = self.bridge["module"]["material"]
        self.section = {t: n for n, t in enumerate(sorted({t for t, _ in self.mesh.shells}), 1)}
        for thickness, n in self.section.items():
            ops.section(
                "ElasticMembranePlateSection",
                n,
                steel["youngs_modulus_pa"],
                steel["poissons_ratio"],
                thickness,
                steel["density_kg_m3"],
            )
        ops.geomTransf("Linear", 1, 0.0, 0.0, 1.0)
        ops.geomTransf("Linear", 2, 1.0, 0.0, 0.0)

    def _structure(self, module, shell):
        mesh, box = self.mesh, self.bridge["module"]
        steel, beam = box["material"], box["stiffeners"]
        e, area, inertia = steel["youngs_modulus_pa"], beam["area_m2"], beam["second_moment_m4"]
        g = e / (2.0 * (1.0 + steel["poissons_ratio"]))
        for ix, iy, iz in mesh.nodes:
            ops.node(self.tag(module, (ix, iy, iz)), module * box["length_m"] + mesh.x[ix], mesh.y[iy], mesh.z[iz])
        for thickness, corners in mesh.shells:
            self._element(shell, *(self.tag(module, c) for c in corners), self.section[thickness])
        for start, end in mesh.beams:
            upright = start[2] != end[2]
            self._element(
                "elasticBeamColumn",
                self.tag(module, start),
                self.tag(module, end),
                area,
                e,
                g,
                beam["torsion_constant_m4"],
                inertia,
                inertia,
                2 if upright else 1,
                "-mass",
                steel["density_kg_m3"] * area,
                "-cMass",
            )

    def _water(self, module, floating):
        """Springs to ground and added mass at the bottom, by tributary area; nothing in x and y but against drift."""
        mesh, bridge = self.mesh, self.bridge
        areas = np.outer(tributary(mesh.x), tributary(mesh.y))
        added_kg_m2 = bridge["added_mass_kg_m"] / bridge["module"]["breadth_m"]
        steel_kg_m2 = 2.0 * bridge["module"]["material"]["density_kg_m3"] * bridge["module"]["bottom_thickness_m"]
        for (ix, iy), area in np.ndenumerate(areas):
            node = self.tag(module, (ix, iy, 0))
            ground = self.modules * len(self.number) + node
            ops.node(ground, *ops.nodeCoord(node))
            ops.fix(ground, 1, 1, 1, 1, 1, 1)
            ops.mass(node, 0.0, 0.0, float(area * added_kg_m2), 0.0, 0.0, 0.0)
            springs = {Z: self._material("Elastic", float(area * bridge["hydrostatic_stiffness_pa_m"]))}
            if floating:
                drift = self._material("Elastic", float(area * steel_kg_m2 * DRIFT_1_S2))
                springs |= {X: drift, Y: drift}
            self._element("zeroLength", ground, node, "-mat", *springs.values(), "-dir", *springs)

    def _joint(self, module, connection):
        """Hinges and connectors between a module and the one before."""
        mesh, connectors = self.mesh, self.bridge["connectors"]
        nx, _, nz = mesh.last
        for iy in (line_at(mesh.y, y) for y in self.bridge["hinges"]["y_m"]):
            ops.equalDOF(self.tag(module - 1, (nx, iy, 0)), self.tag(module, (0, iy, 0)), X, Y, Z)
        tags = []
        for iy in (line_at(mesh.y, y) for y in connectors["y_m"]):
            law = connector_law(connection, connectors["stiffness_n_m"], connectors)
            tags.append(
                self._element(
                    "zeroLength",
                    self.tag(module - 1, (nx, iy, nz)),
                    self.tag(module, (0, iy, nz)),
                    "-mat",
                    self._material(*law),
                    "-dir",
                    X,
                )
            )
        self.connectors.append(tags)

    def _supports(self):
        mesh, supports = self.mesh, self.bridge["supports"]
        hinges = {line_at(mesh.y, y) for y in self.bridge["hinges"]["y_m"]}
        for module, ix, held in ((0, 0, supports["left"]), (self.modules - 1, mesh.last[0], supports["right"])):
            for iy in range(mesh.last[1] + 1):
                x, y = (int(d in held and iy in hinges) for d in ("x", "y"))
                ops.fix(self.tag(module, (ix, iy, 0)), x, y, int("z" in held), 0, 0, 0)

    def load(self, centre_x_m):
        """The footprint's points, each spread bilinearly over the deck's nodes around it."""
        mesh, length = self.mesh, self.bridge["module"]["length_m"]
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        point_n = LOAD_N / (FOOTPRINT_POINTS * len(TRACK_Y_M))
        for i in range(FOOTPRINT_POINTS):
            x = centre_x_m + FOOTPRINT_M * ((i + 0.5) / FOOTPRINT_POINTS - 0.5)
            module = min(int(x / length), self.modules - 1)
            for y in TRACK_Y_M:
                for ix, share_x in spread(mesh.x, x - module * length):
                    for iy, share_y in spread(mesh.y, y):
                        force = -point_n * share_x * share_y
                        ops.load(self.tag(module, (ix, iy, mesh.last[2])), 0.0, 0.0, force, 0.0, 0.0, 0.0)

    def positions(self):
        """Nodes of the module ends at the bottom's centre line."""
        mesh = self.mesh
        centre = line_at(mesh.y, 0.0)
        return [self.tag(m, (0, centre, 0)) for m in range(self.modules)] + [
            self.tag(self.modules - 1, (mesh.last[0], centre, 0))
        ]


def connector_law(connection, k, gaps):
    """Both trusses at once, or each beyond its gap: arguments of a uniaxial material. An open coupling never pulls."""
    if connection == "linear":
        return "Elastic", 2.0 * k
    pull, push = gaps["gap_tension_m"], gaps["gap_compression_m"]
    k_pull = k if gaps.get("tension", True) else 0.0
    return "ElasticMultiLinear", "-strain", -1.0 - push, -push, pull, 1.0 + pull, "-stress", -k, 0.0, 0.0, k_pull


def spread(lines, place):
    """The two lines around a place, with their shares of a load there."""
    i = int(np.clip(np.searchsorted(lines, place) - 1, 0, len(lines) - 2))
    share = (place - lines[i]) / (lines[i + 1] - lines[i])
    return (i, 1.0 - share), (i + 1, share)


def name_shapes(peer, count):
    """Frequencies [Hz] of the domain's modes by name; the motion of the sections with most energy gives the family."""
    squared = ops.eigen("-genBandArpack", count)
    mesh, box = peer.mesh, peer.bridge["module"]
    nx, ny, nz = mesh.last
    sections = [(m, ix) for m in range(peer.modules) for ix in range(nx + 1)]
    x = np.array([m * box["length_m"] + mesh.x[ix] for m, ix in sections])
    centre = line_at(mesh.y, 0.0)
    structure = 2.0 * box["material"]["density_kg_m3"] * box["bottom_thickness_m"] * box["breadth_m"]
    heavy = structure + peer.bridge["added_mass_kg_m"]
    frequencies, numbers = {}, {}
    for mode, lam in enumerate(squared, 1):

        def motion(place, direction, mode=mode):
            return np.array([ops.nodeEigenvector(peer.tag(m, (ix, *place)), mode, direction) for m, ix in sections])

        deck = np.array([motion((iy, nz), Z) for iy in range(ny + 1)])
        roll = mesh.y @ deck / (mesh.y @ mesh.y)
        mid = {d: 0.5 * (motion((centre, 0), d) + motion((centre, nz), d)) for d in (X, Y)}
        families = {
            "vertical bending": (heavy, deck.mean(axis=0)),
            "torsion": (heavy * box["breadth_m"] ** 2 / 12.0, roll),
            "horizontal bending": (structure, mid[Y]),
            "axial": (structure, mid[X]),
        }
        family = max(families, key=lambda f: families[f][0] * np.sum(families[f][1] ** 2))
        profile = families[family][1]
        tilt = np.polyfit(x - x.mean(), profile, 1)
        flat = len(x) * profile.mean() ** 2 / np.sum(profile**2)
        straight = np.sum(np.polyval(tilt, x - x.mean()) ** 2) / np.sum(profile**2)
        if family == "torsion" and flat > 0.95:
            name = "roll"
        elif family != "torsion" and straight > 0.95:
            name = {"vertical bending": "heave" if flat > 0.5 else "pitch"}.get(family, "drift")
        else:
            numbers[family] = numbers.get(family, 0) + 1
            name = f"{family} {numbers[family]}"
        frequencies[name] = np.sqrt(max(lam, 0.0)) / (2.0 * np.pi)
    return frequencies


def opensees_modes(bridge, shell, modules, count):
    """Frequencies [Hz] of a row of modules that floats free, by name."""
    return name_shapes(BridgePeer(bridge, shell, modules, floating=True), count)


def opensees_statics(bridge, shell, connection):
    """Deflections of the positions [m] and forces of the joints [N]."""
    peer = BridgePeer(bridge, shell, bridge["modules"], floating=False, connection=connection)
    peer.load((LOAD_POSITION - 1) * bridge["module"]["length_m"])
    ops.test("NormDispIncr", 1e-9, 50)
    ops.algorithm("Linear" if connection == "linear" else "Newton")
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")
    if ops.analyze(1) != 0:
        sys.exit(f"OpenSees found no equilibrium with the {connection} connection")
    deflection_m = np.array([0.0 - ops.nodeDisp(node, Z) for node in peer.positions()])
    return deflection_m, np.array([sum(ops.basicForce(tag)[0] for tag in joint) for joint in peer.connectors])


# ---- the chain in OpenSees


# Stiffness that stands for a hinge where a constraint may not [N/m]: 150 times an element's own.
HINGE_N_M = 1e12
# spring in x against drift of the chain afloat [N/m]: 0.003 Hz
CHAIN_DRIFT_N_M = 1e3


def joint_connector(chain, joint):
    """Stiffness and gaps of a joint's connector: the chain's, and over them what entries of `"joints"` say of it."""
    own = chain["connectors"] | {"stiffness_n_m": chain["connectors"]["stiffness_of_a_joint_n_m"]}
    for numbers, entry in chain.get("joints", {}).items():
        first, _, last = numbers.partition("..")
        if int(first) <= joint <= int(last or first):
            own |= entry["connectors"]
    return own


def chain_module(chain, number):
    """What the module of a number is and floats on."""
    if number in chain.get("others", []):
        return chain["other"]
    own = {key: chain[key] for key in ("module_length_m", "elements_along_module")}
    return own | {key: chain["beam"][key] for key in ("second_moment_m4", "density_kg_m3")} | chain["water"]


class ChainPeer:
    """The plane chain in OpenSees' domain; dofs x, z, rotation.

    Posts are stiff beams on every node of the line. With `"posts": "rigid"` they are rigid links at the module ends
    alone, as somebody would script it; their nodes cannot be tied at the hinges as well, which are stiff springs then.
    With `"hinges": "springs"` they are so in any case, and tell their forces. Modules whose numbers stand in `"others"`
    are of the file's other kind. Afloat no end is held, but a weak spring holds x.
    """

    def __init__(self, chain, connection, floating=False):
        self.modules = chain["modules"]
        kinds = [chain_module(chain, number) for number in range(1, self.modules + 1)]
        self.parts = [kind["elements_along_module"] for kind in kinds]
        self.lefts_m = np.cumsum([0.0] + [kind["module_length_m"] for kind in kinds])
        self.elements_m = np.diff(self.lefts_m) / self.parts
        self.firsts = np.cumsum([1] + [parts + 1 for parts in self.parts])
        self.length_m = self.lefts_m[-1]
        beam, post, depth_m = chain["beam"], chain["post"], chain["depth_m"]
        tops, grounds = 1000, 2000
        ops.wipe()
        ops.model("basic", "-ndm", 2, "-ndf", 3)
        ops.geomTransf("Linear", 1)
        elements = iter(range(1, 10**6))
        ops.uniaxialMaterial("Elastic", 3, HINGE_N_M)
        for module, kind in enumerate(kinds):
            for share in (1, 2):
                stiffness_n_m = 0.5 * share * self.elements_m[module] * kind["hydrostatic_stiffness_n_m2"]
                ops.uniaxialMaterial("Elastic", self.water(module, share), float(stiffness_n_m))
        for joint in range(2, self.modules + 1):
            own = joint_connector(chain, joint)
            law, *numbers = connector_law(connection, own["stiffness_n_m"], own)
            ops.uniaxialMaterial(law, self.material(joint), *numbers)
        rigid = chain.get("posts") == "rigid"
        springs = rigid or chain.get("hinges") == "springs"
        for module, kind in enumerate(kinds):
            parts, element_m = self.parts[module], self.elements_m[module]
            for i in range(parts + 1):
                node, x = self.node(module, i), float(self.lefts_m[module] + i * element_m)
                ops.node(node, x, 0.0)
                ops.node(grounds + node, x, 0.0)
                ops.fix(grounds + node, 1, 1, 1)
                share = 1 if i in (0, parts) else 2
                ops.mass(node, 0.0, float(0.5 * share * element_m * kind["added_mass_kg_m"]), 0.0)
                spring = ("-mat", self.water(module, share), "-dir", 2, "-doRayleigh", 1)
                ops.element("zeroLength", next(elements), grounds + node, node, *spring)
                if not rigid:
                    ops.node(tops + node, x, depth_m)
                    ops.element(
                        "elasticBeamColumn",
                        next(elements),
                        node,
                        tops + node,
                        post["area_m2"],
                        post["youngs_modulus_pa"],
                        post["second_moment_m4"],
                        1,
                    )
                elif i in (0, parts):
                    ops.node(tops + node, x, depth_m)
                    ops.rigidLink("beam", node, tops + node)
                if i:
                    ops.element(
                        "elasticBeamColumn",
                        next(elements),
                        node - 1,
                        node,
                        beam["area_m2"],
                        beam["youngs_modulus_pa"],
                        kind["second_moment_m4"],
                        1,
                        "-mass",
                        kind["density_kg_m3"] * beam["area_m2"],
                        "-cMass",
                    )
        self.connectors, self.hinges = [], []
        for module in range(1, self.modules):
            left, right = self.node(module - 1, self.parts[module - 1]), self.node(module, 0)
            if springs:
                self.hinges.append(next(elements))
                ops.element("zeroLength", self.hinges[-1], left, right, "-mat", 3, 3, "-dir", 1, 2)
            else:
                ops.equalDOF(left, right, 1, 2)
            self.connectors.append(next(elements))
            law = self.material(module + 1)
            ops.element("zeroLength", self.connectors[-1], tops + left, tops + right, "-mat", law, "-dir", 1)
        self.banks = []
        first, last = self.node(0, 0), self.positions()[-1]
        if floating:
            ops.uniaxialMaterial("Elastic", 4, CHAIN_DRIFT_N_M)
            ops.element("zeroLength", next(elements), grounds + first, first, "-mat", 4, "-dir", 1)
            return
        for end, (node, along) in enumerate(((first, 1), (last, 0))):
            bank_n_m = chain.get("bank_stiffness_n_m")
            ops.fix(node, along, 0 if bank_n_m else 1, 0)
            if bank_n_m:
                # a spring from the ground under the node that pushes and never pulls
                ops.uniaxialMaterial("ENT", 50 + end, bank_n_m)
                self.banks.append(next(elements))
                ops.element("zeroLength", self.banks[-1], grounds + node, node, "-mat", 50 + end, "-dir", 2)
        ops.rayleigh(chain["rayleigh"]["mass_1_s"], chain["rayleigh"]["stiffness_s"], 0.0, 0.0)

    def node(self, module, i):
        """Number of a node of the line."""
        return int(self.firsts[module]) + i

    @staticmethod
    def water(module, share):
        """Number of the water of so many half elements of a module."""
        return 1000 + 2 * module + share

    @staticmethod
    def material(joint):
        """Number of the law of a joint's connector."""
        return 100 + joint

    def positions(self):
        """Nodes of the module ends."""
        return [self.node(m, 0) for m in range(self.modules)] + [int(self.firsts[-1]) - 1]

    def shares(self, x_m):
        """For each place of a point that moves, its shares on the line's nodes; none off the bridge."""
        shares = np.zeros((len(x_m), int(self.firsts[-1]) - 1))
        steps = np.flatnonzero((x_m >= 0.0) & (x_m <= self.length_m))
        module = np.searchsorted(self.lefts_m[1:-1], x_m[steps], side="right")
        elements = (x_m[steps] - self.lefts_m[module]) / self.elements_m[module]
        element = np.minimum(elements.astype(int), np.array(self.parts)[module] - 1)
        ahead = elements - element
        node = self.firsts[module] - 1 + element
        shares[steps, node] = 1.0 - ahead
        shares[steps, node + 1] = ahead
        return shares


def load_shares(peer, load, centre_m):
    """For each place of the load's centre, its shares on the line's nodes."""
    length_m, points = load["footprint_length_m"], load["points"]
    return sum(peer.shares(centre_m + length_m * ((i + 0.5) / points - 0.5)) for i in range(points)) / points


class ChainCrossing:
    """A crossing of the chain that is about to begin, in OpenSees' domain."""

    def __init__(self, chain, crossing, time_step_s, system="BandGeneral", algorithm="Newton"):
        self.peer = peer = ChainPeer(chain, crossing["connection"])
        self.crossing, self.time_step_s = crossing, time_step_s
        load, speed_m_s = chain["load"], crossing["speed_m_s"]
        footprint_m = load["footprint_length_m"]
        self.steps = int(np.ceil(((peer.length_m + footprint_m) / speed_m_s + chain["tail_s"]) / time_step_s))
        # the footprint's front reaches the bridge at time 0
        centre_m = speed_m_s * time_step_s * np.arange(self.steps + 1) - 0.5 * footprint_m
        shares = load_shares(peer, load, centre_m)
        for i, history in enumerate(shares.T, 1):
            ops.timeSeries("Path", i, "-dt", time_step_s, "-values", *map(float, history))
            ops.pattern("Plain", i, i)
            ops.load(i, 0.0, -load["weight_n"], 0.0)
        ops.constraints("Transformation")
        ops.numberer("RCM")
        ops.system(system)
        ops.test("NormDispIncr", 1e-10, 50)
        ops.algorithm("Linear" if crossing["connection"] == "linear" else algorithm)
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")

    def run(self):
        """Deflections of the positions, upward [m], and forces of the joints [N], a row a step."""
        peer = self.peer
        z_m, force_n = np.zeros((self.steps, peer.modules + 1)), np.zeros((self.steps, peer.modules - 1))
        self.hinges_n = np.zeros((self.steps, len(peer.hinges), 2))
        self.banks_n = np.zeros((self.steps, len(peer.banks)))
        for step in range(self.steps):
            if ops.analyze(1, self.time_step_s) != 0:
                sys.exit(f"OpenSees found no equilibrium in step {step} of {self.crossing}")
            z_m[step] = [ops.nodeDisp(node, 2) for node in peer.positions()]
            force_n[step] = [ops.basicForce(tag)[0] for tag in peer.connectors]
            for place, tag in enumerate(peer.hinges):
                self.hinges_n[step, place] = ops.basicForce(tag)[:2]
            for place, tag in enumerate(peer.banks):
                self.banks_n[step, place] = -ops.basicForce(tag)[0]
        return z_m, force_n


def opensees_crossing(chain, crossing, time_step_s):
    """Peaks of the positions and joints of one crossing, by the keys of pontoon's example."""
    z_m, force_n = ChainCrossing(chain, crossing, time_step_s).run()
    return {
        "peak_deflection_m": np.maximum(-z_m, 0.0).max(axis=0),
        "peak_uplift_m": np.maximum(z_m, 0.0).max(axis=0),
        "peak_compression_n": np.maximum(-force_n, 0.0).max(axis=0),
        "peak_tension_n": np.maximum(force_n, 0.0).max(axis=0),
    }


def opensees_chain_modes(chain, count):
    """The lowest frequencies [Hz] of the chain afloat, without that of the drift."""
    ChainPeer(chain, "linear", floating=True)
    ops.constraints("Transformation")
    ops.numberer("RCM")
    ops.system("BandGeneral")
    return np.sqrt(ops.eigen("-genBandArpack", count + 1))[1:] / (2.0 * np.pi)


def opensees_chain_statics(chain, connection, centre_m):
    """Deflections of the positions [m], forces of the joints and of hinges that are springs [N]."""
    peer, load = ChainPeer(chain, connection), chain["load"]
    x_m = np.array([centre_m])
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    for node, share in enumerate(load_shares(peer, load, x_m)[0], 1):
        if share:
            ops.load(node, 0.0, -load["weight_n"] * share, 0.0)
    ops.constraints("Transformation")
    ops.numberer("RCM")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", 1e-10, 50)
    ops.algorithm("Linear" if connection == "linear" else "Newton")
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")
    if ops.analyze(1) != 0:
        sys.exit(f"OpenSees found no equilibrium of the chain under a load at {centre_m} m")
    deflection_m = np.array([0.0 - ops.nodeDisp(node, 2) for node in peer.positions()])
    force_n = np.array([ops.basicForce(tag)[0] for tag in peer.connectors])
    return deflection_m, force_n, np.array([ops.basicForce(tag)[:2] for tag in peer.hinges])


# ---- side by side


def compare_modes(table, bridge, shell, mesh, asked_percent):
    """The single module and the whole bridge, floating free."""
    for title, words, modules, count, names in (
        ("module", ("--module", "--count", 6), 1, 6, ["heave", "roll", "pitch"]),
        ("bridge", ("--count", 24), bridge["modules"], 24, NAMED),
    ):
        ours, ours_s = timed(pontoon_modes, bridge, *words)
        theirs, theirs_s = timed(opensees_modes, bridge, shell, modules, count)
        table.head(f"natural frequencies of the {title}, {mesh}, {shell}", ours_s, theirs_s)
        for name in names:
            table.row(name, "Hz", ours[name], theirs[name], asked_percent)


def compare_statics(table, bridge, shell, mesh, asked_percent):
    """Linear connection and gaps; positions in percent of the largest deflection, joints of the largest force."""
    for connection in ("linear", "nonlinear"):
        ours, ours_s = timed(pontoon_statics, bridge, connection)
        theirs, theirs_s = timed(opensees_statics, bridge, shell, connection)
        table.head(f"static, {connection}, {mesh}, {shell}", ours_s, theirs_s)
        (w_ours, n_ours), (w_theirs, n_theirs) = ours, theirs
        table.row("largest deflection", "m", w_ours.max(), w_theirs.max(), asked_percent)
        for position, (a, b) in enumerate(zip(w_ours, w_theirs, strict=True), 1):
            table.row(f"deflection at {position}, of the largest", "m", a, b, asked_percent, of=w_theirs.max())
        for joint, (a, b) in enumerate(zip(n_ours, n_theirs, strict=True), 2):
            table.row(f"force of joint {joint}, of the largest", "N", a, b, of=np.abs(n_theirs).max())


def compare_chain(table):
    """Crossings of the plane chain, each with OpenSees' own time integration; pontoon's time is that of all crossings.

    Where a position or joint is most off is not judged, uplift and tension least of all: with gaps, what happens far
    from the load depends on when a connector touches, and halving the step moves it as much.
    """
    chain = json.loads(CHAIN.read_text())
    printed, ours_s = timed(subprocess.check_output, [os.environ["PONTOON_CHAIN"]])
    for ours, crossing in zip(json.loads(printed)["crossings"], chain["crossings"], strict=True):
        theirs, theirs_s = timed(opensees_crossing, chain, crossing, CHAIN_TIME_STEP_S)
        table.head(f"chain, {crossing['connection']}, {crossing['speed_m_s']:g} m/s", ours_s, theirs_s)
        w, n, pull = "peak_deflection_m", "peak_compression_n", "peak_tension_n"
        forces = [max(*side[n], *side[pull]) for side in (ours, theirs)]
        table.row("largest deflection", "m", max(ours[w]), max(theirs[w]), 0.5)
        table.row("deflection at 7", "m", ours[w][6], theirs[w][6], 0.5)
        table.row("largest force of a joint", "N", *forces, 2.0)
        table.row("compression of joint 7", "N", ours[n][5], theirs[n][5], 2.0)
        for key, largest in ((w, max(theirs[w])), ("peak_uplift_m", max(theirs[w])), (n, forces[1]), (pull, forces[1])):
            _, what, unit = key.split("_")
            off = int(np.argmax(np.abs(ours[key] - theirs[key])))
            place = off + (1 if unit == "m" else 2)
            name = f"{what} most off, at {place}, of the largest"
            table.row(name, {"m": "m", "n": "N"}[unit], ours[key][off], theirs[key][off], of=largest)


# joints that are not alike, by what is said of them: words of a scenario of the chain
JOINTS = {
    "joint 8 with a gap of 20 mm": {"8": {"connectors": {"gap_compression_m": 0.020}}},
    "joint 7 of half the stiffness": {"7": {"connectors": {"stiffness_n_m": 2.37e7}}},
    "all tension connectors open": {"2..15": {"connectors": {"tension": False}}},
}
JOINTS_SPEEDS_M_S = {name: [3.0] for name in JOINTS} | {"joint 7 of half the stiffness": [3.0, 15.0]}


def compare_joints(table):
    """The chain with joints of their own: a load that stands on a position, and crossings."""
    chain = json.loads(CHAIN.read_text())
    for name, joints in JOINTS.items():
        worn = chain | {"joints": joints}
        still = {"joints": joints, "analysis": {"kind": "static"}, "load_position": LOAD_POSITION}
        ours, ours_s = timed(pontoon_chain, still)
        centre_m = (LOAD_POSITION - 1) * chain["module_length_m"]
        (w_theirs, n_theirs, _), theirs_s = timed(opensees_chain_statics, worn, "nonlinear", centre_m)
        table.head(f"chain, {name}, static", ours_s, theirs_s)
        w_ours = np.array([p["deflection_m"] for p in ours["positions"]])
        n_ours = np.array([j["force_n"] for j in ours["joints"]])
        table.row("largest deflection", "m", w_ours.max(), w_theirs.max(), 0.5)
        for position in (6, 7, 8):
            w = w_ours[position - 1], w_theirs[position - 1]
            table.row(f"deflection at {position}", "m", *w, 0.5)
        for joint in (6, 7, 8):
            table.row(f"force of joint {joint}", "N", n_ours[joint - 2], n_theirs[joint - 2], 0.5)
        for speed_m_s in JOINTS_SPEEDS_M_S[name]:
            crossing = {"connection": "nonlinear", "speed_m_s": speed_m_s}
            ours, ours_s = timed(pontoon_chain, {"joints": joints} | crossing)
            theirs, theirs_s = timed(opensees_crossing, worn, crossing, CHAIN_TIME_STEP_S)
            table.head(f"chain, {name}, {speed_m_s:g} m/s", ours_s, theirs_s)
            most, w, n = ours["largest"], theirs["peak_deflection_m"], theirs["peak_compression_n"]
            table.row("largest deflection", "m", most["peak_deflection_m"], max(w), 0.5)
            table.row("deflection at 7", "m", ours["positions"][6]["peak_deflection_m"], w[6], 0.5)
            table.row("largest compression of a joint", "N", most["peak_compression_n"], max(n), 2.0)
            table.row("compression of joint 7", "N", ours["joints"][5]["peak_compression_n"], n[5], 2.0)
            pull = theirs["peak_tension_n"]
            table.row("largest tension, of the compression", "N", most["peak_tension_n"], max(pull), of=max(n))


# modules of the other kind, longer and of other stiffness, mass and water: at both ends and inside
OTHERS = [1, 2, 6, 15]
OTHERS_MODES = 12


def compare_kinds(table):
    """The chain of two kinds of modules: frequencies afloat, loads that stand, a crossing."""
    chain = json.loads(CHAIN.read_text()) | {"others": OTHERS}
    ours, ours_s = timed(pontoon_chain, {"others": OTHERS, "analysis": {"kind": "modes"}})
    theirs, theirs_s = timed(opensees_chain_modes, chain, OTHERS_MODES)
    table.head("chain of two kinds, natural frequencies", ours_s, theirs_s)
    vertical = [mode["frequency_hz"] for mode in ours["modes"] if mode["vertical_share"] > 0.5]
    for number, (a, b) in enumerate(zip(vertical, theirs, strict=False), 1):
        table.row(f"vertical mode {number}", "Hz", a, b, 0.5)
    for connection in ("linear", "nonlinear"):
        still = {
            "others": OTHERS,
            "connection": connection,
            "analysis": {"kind": "static"},
            "load_position": LOAD_POSITION,
        }
        ours, ours_s = timed(pontoon_chain, still)
        centre_m = ours["load_x_m"]
        (w, n, _), theirs_s = timed(opensees_chain_statics, chain, connection, centre_m)
        table.head(f"chain of two kinds, static, {connection}", ours_s, theirs_s)
        for position in (5, 6, 7, 8):
            deflection_m = ours["positions"][position - 1]["deflection_m"]
            table.row(f"deflection at {position}", "m", deflection_m, w[position - 1], 0.5)
        for joint in (6, 7, 8):
            table.row(f"force of joint {joint}", "N", ours["joints"][joint - 2]["force_n"], n[joint - 2], 0.5)
    crossing = {"connection": "nonlinear", "speed_m_s": 3.0}
    ours, ours_s = timed(pontoon_chain, {"others": OTHERS} | crossing)
    theirs, theirs_s = timed(opensees_crossing, chain, crossing, CHAIN_TIME_STEP_S)
    table.head("chain of two kinds, 3 m/s", ours_s, theirs_s)
    most, w, n = ours["largest"], theirs["peak_deflection_m"], theirs["peak_compression_n"]
    table.row("largest deflection", "m", most["peak_deflection_m"], max(w), 0.5)
    table.row("deflection at 7", "m", ours["positions"][6]["peak_deflection_m"], w[6], 0.5)
    table.row("largest compression of a joint", "N", most["peak_compression_n"], max(n), 2.0)


# places of the load's centre [m]: on a position, and half a module beyond it
PINS_CENTRES_M = (40.2, 43.55)


def compare_pins(table):
    """Forces of the hinges on the part left of them: springs in OpenSees, what the left module needs in pontoon.

    Points of the load pass a joint one by one, and its force upward jumps by theirs: 3 % of the largest in crossings.
    """
    chain = json.loads(CHAIN.read_text()) | {"hinges": "springs"}
    for centre_m in PINS_CENTRES_M:
        ours, ours_s = timed(pontoon_chain, {"analysis": {"kind": "static"}, "load_x_m": centre_m})
        (_, _, theirs), theirs_s = timed(opensees_chain_statics, chain, "nonlinear", centre_m)
        table.head(f"chain, pins, static at {centre_m:g} m", ours_s, theirs_s)
        of = np.abs(theirs).max()
        for joint in (6, 7, 8):
            pin, (along, up) = ours["pins"][joint - 2], theirs[joint - 2]
            table.row(f"pin {joint} along, of the largest", "N", pin["x_n"], along, 0.5, of=of)
            table.row(f"pin {joint} up, of the largest", "N", pin["z_n"], up, 0.5, of=of)
    crossing = {"connection": "nonlinear", "speed_m_s": 3.0}
    ours, ours_s = timed(pontoon_chain, crossing)
    peer = ChainCrossing(chain, crossing, CHAIN_TIME_STEP_S)
    _, theirs_s = timed(peer.run)
    table.head("chain, pins, 3 m/s", ours_s, theirs_s)
    along, up = peer.hinges_n[:, :, 0], peer.hinges_n[:, :, 1]
    of = max(np.abs(along).max(), np.abs(up).max())
    for joint in (2, 7, 12):
        pin = ours["pins"][joint - 2]
        for key, values in (
            ("peak_plus_x_n", along),
            ("peak_minus_x_n", -along),
            ("peak_plus_z_n", up),
            ("peak_minus_z_n", -up),
        ):
            table.row(
                f"{key} of pin {joint}, of the largest", "N", pin[key], max(values[:, joint - 2].max(), 0.0), 3.0, of=of
            )


# stiffness of the banks at both ends [N/m], and where the load's centre stands [m]: all of it on the bridge
BANK_N_M, BANK_CENTRE_M = 1e7, 1.675


def compare_banks(table):
    """The chain on one-sided springs at both ends: a load beside the left one, and a crossing."""
    chain = json.loads(CHAIN.read_text()) | {"bank_stiffness_n_m": BANK_N_M}
    banks = [{"at": end, "direction": "z", "stiffness_n_m": BANK_N_M} for end in ("left", "right")]
    still = {"banks": banks, "analysis": {"kind": "static"}, "load_x_m": BANK_CENTRE_M}
    ours, ours_s = timed(pontoon_chain, still)
    (w, n, _), theirs_s = timed(opensees_chain_statics, chain, "nonlinear", BANK_CENTRE_M)
    table.head("chain on banks, static", ours_s, theirs_s)
    for position in (1, 2):
        table.row(
            f"deflection at {position}", "m", ours["positions"][position - 1]["deflection_m"], w[position - 1], 0.5
        )
    table.row("force of joint 2", "N", ours["joints"][0]["force_n"], n[0], 0.5)
    table.row("left bank", "N", ours["banks"][0]["force_n"], BANK_N_M * w[0], 0.5)
    crossing = {"connection": "nonlinear", "speed_m_s": 3.0}
    ours, ours_s = timed(pontoon_chain, crossing | {"banks": banks})
    peer = ChainCrossing(chain, crossing, CHAIN_TIME_STEP_S)
    (z_m, force_n), theirs_s = timed(peer.run)
    table.head("chain on banks, 3 m/s", ours_s, theirs_s)
    table.row("deflection at 7", "m", ours["positions"][6]["peak_deflection_m"], -z_m[:, 6].min(), 0.5)
    table.row("largest compression of a joint", "N", ours["largest"]["peak_compression_n"], -force_n.min(), 2.0)
    for bank, name in enumerate(("left", "right")):
        table.row(f"{name} bank", "N", ours["banks"][bank]["peak_toward_n"], peer.banks_n[:, bank].max(), 1.0)


def main():
    """Runs the parts that are asked for; exit status 1 where a deviation is beyond what is asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("part", nargs="?", default="all", choices=["modes", "statics", "chain", "all"])
    parser.add_argument("--refined", action="store_true", help="modes and statics on the refined mesh too")
    parser.add_argument("--shell", default="ASDShellQ4", help="OpenSees' shell element")
    options = parser.parse_args()
    table, start = Table(), time.perf_counter()
    with tempfile.NamedTemporaryFile() as log:
        ops.logFile(log.name, "-noEcho")
        # where the file's numbers come from says nothing about a bridge of another mesh
        bridge = {key: value for key, value in json.loads(BRIDGE.read_text()).items() if key != "provenance"}
        meshes = [("mesh of the file", bridge, 1.0)]
        if options.refined:
            meshes.append(("refined mesh", bridge | {"module": bridge["module"] | {"mesh": REFINED}}, 0.5))
        for mesh, meshed, asked_percent in meshes:
            if options.part in ("modes", "all"):
                compare_modes(table, meshed, options.shell, mesh, asked_percent)
            if options.part in ("statics", "all"):
                compare_statics(table, meshed, options.shell, mesh, asked_percent)
        if options.part in ("chain", "all"):
            compare_chain(table)
            compare_joints(table)
            compare_kinds(table)
            compare_pins(table)
            compare_banks(table)
    print(f"\n{time.perf_counter() - start:.0f} s; beyond what is asked: {len(table.beyond)}")
    for name in table.beyond:
        print(f"  {name}")
    sys.exit(1 if table.beyond else 0)


if __name__ == "__main__":
    main()
