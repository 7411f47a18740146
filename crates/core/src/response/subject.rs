//! What a number of the response is of: a deflection, a force, an angle, a section force.
//!
//! Knows which numbers a bridge has and which a joint's others come from. Does not know solvers or tables.

use super::ride::{BodyMotion, RideReading};

/// What a recorded number is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Deflection, positive downward `[m]`.
    Deflection,
    /// Force of a joint, its connectors added, or of one connector, tension positive `[N]`.
    Force,
    /// Force of a pin on the module left of it, toward +x, +y or +z `[N]`.
    Pin(Axis),
    /// Section force of a joint, or its angle.
    Section(Section),
    /// Force of a wheel on its spring, downward on the deck `[N]`.
    Wheel,
    /// Motion of a body from rest on a level road.
    Body(BodyMotion),
}

/// An axis of the bridge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Axis {
    /// Along.
    X,
    /// Across.
    Y,
    /// Up.
    Z,
}

/// What holds at a joint as a whole. Forces are those of the right part on the left one, moments about the hinge line's
/// centre. Equation (J7).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Section {
    /// Rotation of the right module against the left one, positive where the joint opens at the deck `[rad]`.
    Angle,
    /// Axial force, tension positive `[N]`.
    Axial,
    /// Shear across, toward +y `[N]`.
    ShearY,
    /// Shear upward `[N]`.
    ShearZ,
    /// Torsion about +x `[N m]`.
    Torsion,
    /// Bending moment, positive where the deck is compressed `[N m]`.
    Bending,
    /// Bending moment about +z `[N m]`.
    LateralBending,
}

/// Number of [`Section::ALL`].
pub const SECTIONS: usize = 7;

impl Section {
    /// All of them.
    pub const ALL: [Self; SECTIONS] = [
        Self::Angle,
        Self::Axial,
        Self::ShearY,
        Self::ShearZ,
        Self::Torsion,
        Self::Bending,
        Self::LateralBending,
    ];
}

impl Axis {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];
}

/// What a number of the response is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    /// Deflection of a position, 1 to modules + 1.
    Position(usize),
    /// Deflection of a recorded place, by its index in the list of places.
    Place(usize),
    /// Force of a joint, its connectors added.
    Joint(usize),
    /// Force of a connector.
    Connector {
        /// Its joint.
        joint: usize,
        /// Its index among the joint's.
        index: usize,
    },
    /// Force of a pin.
    Pin {
        /// Its joint.
        joint: usize,
        /// Its index among the joint's.
        index: usize,
        /// Its direction.
        axis: Axis,
    },
    /// Section force or angle of a joint.
    Section {
        /// The joint.
        joint: usize,
        /// Which one.
        of: Section,
    },
    /// Force of a wheel on its spring; 0 while its vehicle is not there.
    Wheel {
        /// Its vehicle, from 0.
        vehicle: usize,
        /// Its number in the vehicle, from 0, patch after patch.
        wheel: usize,
    },
    /// Motion of the body of a vehicle on springs; 0 while it is not there.
    Body {
        /// The vehicle, from 0.
        vehicle: usize,
        /// Which motion.
        motion: BodyMotion,
    },
}

impl Subject {
    /// What its number is.
    pub fn quantity(self) -> Quantity {
        match self {
            Self::Position(_) | Self::Place(_) => Quantity::Deflection,
            Self::Joint(_) | Self::Connector { .. } => Quantity::Force,
            Self::Pin { axis, .. } => Quantity::Pin(axis),
            Self::Section { of, .. } => Quantity::Section(of),
            Self::Wheel { .. } => Quantity::Wheel,
            Self::Body { motion, .. } => Quantity::Body(motion),
        }
    }

    /// Its position or joint; none of a place or vehicle.
    pub fn position(self) -> Option<usize> {
        match self {
            Self::Position(position) => Some(position),
            Self::Place(_) | Self::Wheel { .. } | Self::Body { .. } => None,
            Self::Joint(joint)
            | Self::Connector { joint, .. }
            | Self::Pin { joint, .. }
            | Self::Section { joint, .. } => Some(joint),
        }
    }

    /// Whether its number holds at the instant of the step's balance and not at the step's end.
    pub fn is_of_balance(self) -> bool {
        match self {
            Self::Pin { .. } => true,
            Self::Section { of, .. } => of != Section::Angle,
            _ => false,
        }
    }
}

/// What a joint consists of: which connectors and pins of the bridge are its own, and where they are.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JointParts {
    /// Its number, from 2.
    pub joint: usize,
    /// Its first connector among all, and where they are across `[m]`.
    pub first_connector: usize,
    pub connectors_y_m: Vec<f64>,
    /// Its first pin among all, and where they are across `[m]`.
    pub first_pin: usize,
    pub pins_y_m: Vec<f64>,
    /// Height of the connectors above the hinge line `[m]`.
    pub depth_m: f64,
}

/// The spring of a bank at one place across.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BankPart {
    /// The bank, from 0.
    pub bank: usize,
    /// Place across `[m]`.
    pub y_m: f64,
    /// Where its force is read.
    pub source: BankSource,
}

/// Where the force of a bank's spring is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum BankSource {
    /// A link, by its place among all.
    Link(usize),
    /// A spring that holds both ways, by its place among these, and its stiffness `[N/m]`.
    Spring(usize, f64),
}

impl BankPart {
    /// Its force on the bridge along its sense `[N]`.
    pub(crate) fn force_n(&self, reading: &impl JointReading) -> f64 {
        match self.source {
            BankSource::Link(link) => 0.0 - reading.force_n(link),
            BankSource::Spring(index, stiffness_n_m) => 0.0 - stiffness_n_m * reading.spring_m(index),
        }
    }
}

/// What joints do, to be read.
pub(crate) trait JointReading {
    /// Force of a connector, now and at the balance `[N]`.
    fn connector_n(&self, connector: usize) -> [f64; 2];
    /// Force of a connector now `[N]`.
    fn force_n(&self, connector: usize) -> f64 {
        self.connector_n(connector)[0]
    }
    /// Force of a joint, its connectors added, of which the first is given and how many there are `[N]`.
    fn joint_n(&self, first: usize, count: usize) -> f64 {
        (first..first + count).map(|connector| self.force_n(connector)).sum()
    }
    /// Elongation of a connector `[m]`.
    fn elongation_m(&self, connector: usize) -> f64;
    /// Force of a pin at the balance `[N]`.
    fn pin_n(&self, pin: usize) -> [f64; 3];
    /// Motion of a spring that holds both ways, along its sense `[m]`.
    fn spring_m(&self, spring: usize) -> f64;
}

/// A state of the bridge, to be read.
pub(crate) trait Reading: JointReading {
    /// The time `[s]`, and the instant of the balance before it `[s]`.
    fn times_s(&self) -> [f64; 2];
    /// Deflection of a position, from 0 `[m]`.
    fn position_m(&self, index: usize) -> f64;
    /// Deflection of a place `[m]`.
    fn place_m(&self, index: usize) -> f64;
    /// Deflection of a corner of a module's deck `[m]`.
    fn corner_m(&self, index: usize) -> f64;
    /// A vehicle on springs; none while it is not there.
    fn ride(&self, vehicle: usize) -> Option<RideReading<'_>>;
    /// Whether all points of a wheel are on the bridge.
    fn is_on(&self, vehicle: usize, wheel: usize) -> bool;
}

impl JointParts {
    /// Angle and section forces, in the order of [`Section::ALL`].
    /// Equation (J7).
    pub(crate) fn sections(&self, reading: &impl JointReading) -> [f64; SECTIONS] {
        let mut of = [0.0; SECTIONS];
        let [angle, axial, shear_y, shear_z, torsion, bending, lateral] = &mut of;
        let per = 1.0 / (self.depth_m * self.connectors_y_m.len() as f64);
        for (connector, y) in (self.first_connector..).zip(&self.connectors_y_m) {
            let [_, force] = reading.connector_n(connector);
            *angle += per * reading.elongation_m(connector);
            *axial += force;
            *bending -= self.depth_m * force;
            *lateral -= y * force;
        }
        for (pin, y) in (self.first_pin..).zip(&self.pins_y_m) {
            let [along, across, up] = reading.pin_n(pin);
            *axial += along;
            *shear_y += across;
            *shear_z += up;
            *torsion += y * up;
            *lateral -= y * along;
        }
        of
    }

    /// The force of the joint, its connectors added.
    pub(crate) fn force_n(&self, reading: &impl JointReading) -> f64 {
        reading.joint_n(self.first_connector, self.connectors_y_m.len())
    }
}

/// The number of a subject.
pub(crate) fn read(subject: Subject, joints: &[JointParts], reading: &impl Reading) -> f64 {
    match subject {
        Subject::Position(position) => reading.position_m(position - 1),
        Subject::Place(index) => reading.place_m(index),
        Subject::Joint(joint) => joints[joint - 2].force_n(reading),
        Subject::Connector { joint, index } => reading.force_n(joints[joint - 2].first_connector + index),
        Subject::Pin { joint, index, axis } => reading.pin_n(joints[joint - 2].first_pin + index)[axis as usize],
        Subject::Section { joint, of } => joints[joint - 2].sections(reading)[of as usize],
        Subject::Wheel { vehicle, wheel } => reading.ride(vehicle).map_or(0.0, |ride| ride.wheel_n(wheel)),
        Subject::Body { vehicle, motion } => reading.ride(vehicle).map_or(0.0, |ride| ride.moved(motion)),
    }
}
