//! Two ways to one answer: operator and reference solver, lanes, super-element and full model; the energy balance.

mod banks;
mod chain;
mod chain_scenario;
mod dashpots;
mod dead;
mod energy;
mod joints;
mod kinds;
mod lanes;
mod meshed;
mod one_side;
mod operator;
mod operator_accuracy;
mod operator_lanes;
mod pins;
mod placed;
mod probe;
mod ramps;
mod shapes;
mod stresses;
mod superelement;
mod traffic;
