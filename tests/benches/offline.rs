//! What is done once for a bridge: finite elements, condensation, assembly, operator, and its full modes.
//!
//! Knows the default bridge. Does not know crossings. `cargo bench --profile quick --workspace --bench offline`; no test runs it.

#![allow(missing_docs, clippy::expect_used)]

use divan::Bencher;
use pontoon_core::analysis::modes::modes;
use pontoon_core::bridge::{Bridge, BridgeDesign, Ends, Model, PreparedModule};
use pontoon_core::fem::{MassKind, assemble};
use pontoon_core::operator::BridgeOperator;
use pontoon_tests::design;
use pontoon_tests::scenario::{BRIDGE, OPERATOR_TOLERANCE};

fn main() {
    divan::main();
}

fn module(design: &BridgeDesign, model: Model) -> PreparedModule {
    PreparedModule::new(design, model).expect("a module")
}

fn bridge(design: &BridgeDesign, module: &PreparedModule, ends: Ends) -> Bridge {
    Bridge::new(design, module, ends).expect("a bridge")
}

/// Mesh and matrices of one module's shells and beams, without water.
#[divan::bench(sample_count = 10)]
fn module_assembly(bencher: Bencher<'_, '_>) {
    let design = design(BRIDGE);
    bencher.bench_local(|| assemble(&design.module_mesh().mesh, MassKind::Consistent).expect("matrices"));
}

/// The module from its design to its condensed matrices, finite elements included.
#[divan::bench(sample_count = 5)]
fn module_condensation(bencher: Bencher<'_, '_>) {
    let design = design(BRIDGE);
    bencher.bench_local(|| module(&design, Model::SuperElement));
}

/// The bridge of either model from its module.
#[divan::bench(args = [Model::SuperElement, Model::Full], sample_count = 5)]
fn bridge_assembly(bencher: Bencher<'_, '_>, model: &Model) {
    let design = design(BRIDGE);
    let module = module(&design, *model);
    bencher.bench_local(|| bridge(&design, &module, Ends::Supported));
}

/// The operator of the condensed bridge.
#[divan::bench(sample_count = 3)]
fn operator(bencher: Bencher<'_, '_>) {
    let design = design(BRIDGE);
    let bridge = bridge(&design, &module(&design, Model::SuperElement), Ends::Supported);
    bencher.bench_local(|| BridgeOperator::new(&bridge, OPERATOR_TOLERANCE).expect("an operator"));
}

/// Twenty modes of the bridge of all degrees of freedom, floating free.
#[divan::bench(sample_count = 3)]
fn full_modes(bencher: Bencher<'_, '_>) {
    let design = design(BRIDGE);
    let bridge = bridge(&design, &module(&design, Model::Full), Ends::Free);
    bencher.bench_local(|| modes(&bridge, 20).expect("modes"));
}
