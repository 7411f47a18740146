//! Designs of a study: axes, blocks, the points they expand to.
//!
//! Knows what a person may write of axes and how points are drawn. Does not know bridges, vehicles or jobs.

mod axes;
mod block;
mod cases;
mod column;
mod condition;
mod forms;
mod grid_sieve;
mod points;
mod saltelli;
mod samples;
mod sampling;
#[cfg(test)]
mod sensitivity_tests;
#[cfg(test)]
mod tests;
mod trajectories;
mod values;

pub use axes::{
    Axis, AxisValues, CROSSING_TYPES, Goes, JobAxis, NAMED_AXES, NORMAL_SPEEDS_M_S, NamedAxis, Root, Varies,
};
pub use block::{Block, DesignPoint, PointGroups};
pub use cases::Cases;
pub use condition::{Condition, Conditions, Relation};
pub use forms::{AxisMap, Design, Form, MorrisSpec, RangeMap, SaltelliSpec, SampleSpec};
pub use trajectories::TrajectoryStep;
