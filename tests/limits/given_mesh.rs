//! A module given as a mesh: the box's own mesh gives the same bridge, and what is no module is refused by name.

#![allow(clippy::expect_used)]

use pontoon_core::bridge::{Bridge, BridgeDesign, BridgeError, Ends, Model, PreparedModule};
use pontoon_core::connector::Connection;
use pontoon_core::fem::NodeId;
use pontoon_core::module::{Grid, ModuleMesh};
use pontoon_core::vehicle::Inertia;
use pontoon_tests::beams::BeamModule;
use pontoon_tests::*;

/// The mesh of the box handed over is the box: the same numbers to the last bit. Twin: the same mesh with all plates 5 %
/// thicker. Tolerance 0: nothing is computed otherwise.
#[test]
fn mesh_of_the_box_is_the_box() {
    let d = design("smoke");
    let deflection_m = |factor: Option<f64>| {
        let ready = match factor {
            None => Ready::new(&d, Model::SuperElement),
            Some(f) => {
                let mut given = d.module_mesh();
                given.mesh.shells.iter_mut().for_each(|s| s.section.thickness_m *= f);
                Ready::of(
                    &d,
                    PreparedModule::from_mesh(&d, given, Model::SuperElement).expect("a module"),
                )
            }
        };
        let case = ready.case(Connection::Linear, PAPER_LOAD_N, 6.7);
        ready
            .statics(&footprint(&[-1.4, 1.4], Inertia::None))
            .solve(&case)
            .expect("solved")
            .deflection_m
    };
    let own = deflection_m(None);
    held(
        "given box",
        0.0,
        apart(&deflection_m(Some(1.0)), &own),
        apart(&deflection_m(Some(1.05)), &own),
    );
}

/// The key of a refusal.
fn key(of: Result<PreparedModule, BridgeError>) -> String {
    match of {
        Err(BridgeError::Design(refused)) => refused.key,
        other => panic!("not refused by name: {:?}", other.map(|m| m.dofs())),
    }
}

/// The key that a change must be refused with, and the change.
type Change<T> = (&'static str, fn(&mut T));

fn beam() -> (BeamModule, BridgeDesign) {
    let beam = BeamModule::slender(10.0, 4, 1e9, 1000.0, 1e3);
    let design = beam.design(2, 1e4, 0.0, 1e7);
    (beam, design)
}

/// A place without a line, a grid that ends elsewhere, a node elsewhere or nowhere: each refused with its key, none
/// dropped, none a panic. The module that is right is not.
#[test]
fn what_does_not_fit_is_refused_by_name() {
    let (beam, good) = beam();
    let of = |d: &BridgeDesign, mesh: ModuleMesh| PreparedModule::from_mesh(d, mesh, Model::Full);
    assert!(of(&good, beam.mesh()).is_ok());
    let designs: [Change<BridgeDesign>; 7] = [
        ("hinges.y_m[1]", |d| d.hinges.y_m = vec![-1.0, 0.5]),
        ("connectors.y_m[0]", |d| d.connectors.y_m = vec![0.0]),
        ("grid.x", |d| d.module.length_m = 10.5),
        ("grid.x", |d| d.module.length_m = 9.5),
        ("grid.y", |d| d.module.breadth_m = 2.1),
        ("grid.deck[0]", |d| d.module.depth_m = 1.05),
        ("modules", |d| d.modules = 0),
    ];
    for (expected, change) in designs {
        assert_eq!(key(of(&with(&good, change), beam.mesh())), expected);
    }
    let meshes: [Change<ModuleMesh>; 7] = [
        ("beams[3]", |m| m.mesh.beams[3].nodes[1] = NodeId(1000)),
        ("grid.bottom[2]", |m| m.mesh.nodes[2].z = 0.01),
        ("grid.bottom[2]", |m| m.mesh.nodes[2].x = f64::NAN),
        ("grid.deck", |m| {
            m.mesh.nodes.truncate(19);
        }),
        ("grid.x[2]", |m| m.grid.x[2] = 2.0),
        ("grid.x", |m| m.grid.x.truncate(1)),
        ("grid.deck", |m| m.grid.y.insert(1, 0.0)),
    ];
    for (expected, change) in meshes {
        let mut mesh = beam.mesh();
        change(&mut mesh);
        let found = key(of(&good, mesh));
        // beams[3] is the first to name a node that was cut off, where nodes were cut off
        assert!(
            found == expected || (expected == "grid.deck" && found.starts_with("beams")),
            "{found}"
        );
    }
    // a module prepared for other hinges does not serve
    let module = of(&good, beam.mesh()).expect("a module");
    let other = with(&good, |d| d.hinges.y_m = vec![0.0]);
    let refused = Bridge::new(&other, &module, Ends::Free).expect_err("no line at the hinge");
    assert!(matches!(refused, BridgeError::Design(e) if e.key == "hinges.y_m[0]"));
}

/// A node that nothing holds: a typed error of the finite elements, not a panic.
#[test]
fn mechanism_is_an_error() {
    let (beam, d) = beam();
    let mut mesh = beam.mesh();
    mesh.mesh.add_node([5.0, 0.0, 0.5].into());
    let loose = PreparedModule::from_mesh(&d, mesh, Model::SuperElement);
    assert!(
        matches!(loose, Err(BridgeError::Fem(_))),
        "{:?}",
        loose.map(|m| m.dofs())
    );
}

/// What is no grid is refused with its key.
#[test]
fn grids_are_checked() {
    let nodes = |from: usize| (from..from + 4).map(NodeId).collect::<Vec<_>>();
    let grid = |x: &[f64], y: &[f64], deck: Vec<NodeId>, bottom| Grid::new(x.to_vec(), y.to_vec(), deck, bottom);
    assert!(grid(&[0.0, 1.0], &[-1.0, 1.0], nodes(0), nodes(4)).is_ok());
    for (expected, refused) in [
        ("x", grid(&[0.0], &[-1.0, 1.0], nodes(0), nodes(4))),
        ("y", grid(&[0.0, 1.0], &[], nodes(0), nodes(4))),
        ("x[1]", grid(&[0.0, 0.0], &[-1.0, 1.0], nodes(0), nodes(4))),
        ("x[1]", grid(&[0.0, f64::NAN], &[-1.0, 1.0], nodes(0), nodes(4))),
        ("y[1]", grid(&[0.0, 1.0], &[1.0, -1.0], nodes(0), nodes(4))),
        (
            "deck",
            grid(&[0.0, 1.0], &[-1.0, 1.0], nodes(0)[..3].to_vec(), nodes(4)),
        ),
        (
            "bottom",
            grid(&[0.0, 1.0], &[-1.0, 1.0], nodes(0), nodes(4)[..3].to_vec()),
        ),
        ("deck, bottom", grid(&[0.0, 1.0], &[-1.0, 1.0], nodes(0), nodes(3))),
    ] {
        assert_eq!(refused.expect_err(expected).key, expected);
    }
}
