//! Modules in a row: numbering with ties and supports, matrices, and the rows by which the bridge is loaded and read.
//!
//! Knows where everything is along the bridge. Does not know what is done with it.

use super::banks::{BankSpring, bank_springs};
use super::dead::DeadLoads;
use super::link_row::{LinkPlace, LinkRow, SpringPlace, UpwardForce};
use super::module_place::ModulePlace;
use super::modules::Modules;
use super::pins::{PinPlace, pins};
use super::prepared::{PreparedModule, Side, X, Y, Z};
use super::product::ModuleProduct;
use super::row::{HeldDof, Row};
use super::waves::BridgeWaves;
use super::{BridgeDesign, BridgeError, Direction, Ends, Model};
use crate::fem::{NodeId, SparseRow, SymmetricMatrix};
use crate::input::{InvalidInput, SAME_PLACE_M};
use crate::module::Grid;
use crate::response::{BankPart, BankSource, DeadState};
use std::borrow::Borrow;

/// An assembled bridge: `K`, `M` with ties and supports exact, connectors apart. Shared read-only between jobs and threads.
/// Equation (K1).
#[derive(Debug)]
pub struct Bridge {
    design: BridgeDesign,
    model: Model,
    pub(crate) k: SymmetricMatrix,
    pub(crate) m: SymmetricMatrix,
    /// Products with `k`, module by module.
    pub(crate) times_k: ModuleProduct,
    /// Products with `m`.
    pub(crate) times_m: ModuleProduct,
    /// Products with what the water's springs have of `k`.
    pub(crate) times_k_water: ModuleProduct,
    /// Water with memory, where the bridge has it; its mass is part of `m`.
    pub(crate) waves: Option<BridgeWaves>,
    /// Connectors, joint after joint, each joint's in the design's order.
    pub(crate) links: Vec<LinkRow>,
    /// How many of these are connectors of joints; springs of banks stand behind them.
    pub(crate) joint_connectors: usize,
    /// Springs that hold both ways.
    pub(crate) springs: Vec<SpringPlace>,
    /// z at the bottom's centre line of positions 1 to modules + 1.
    pub(crate) positions: Vec<SparseRow>,
    /// Place along the bridge and z at the bottom's centre line, node after node.
    pub(crate) centre_line: Vec<(f64, SparseRow)>,
    /// z of the deck's two edges, each with the position of its module's nearer end.
    pub(crate) edges: Vec<(usize, SparseRow)>,
    /// z of the deck's corners.
    pub(crate) deck_corners: Vec<SparseRow>,
    /// z of the corners of the bottoms' wet parts.
    pub(crate) bottom_corners: Vec<SparseRow>,
    /// Motion along, across and up of each module's eight corners, see [`crate::analysis::modes::shapes`].
    pub(crate) corners: Vec<[SparseRow; 3]>,
    /// Roll of the module ends, each with its position, and trim of the modules `[rad per unit dof]`.
    pub(crate) rolls: Vec<(usize, SparseRow)>,
    pub(crate) trims: Vec<SparseRow>,
    /// z across the deck at each line along, for telling shapes apart (the bottom's plates carry the water, and shapes of
    /// their own would pass for the bridge's): place x, then (y, row) for each line across.
    pub(crate) sections: Vec<(f64, Vec<(f64, SparseRow)>)>,
    /// Mean motion of the hinge nodes along and across at each module end: place x, row along, row across.
    pub(crate) hinge_lines: Vec<(f64, SparseRow, SparseRow)>,
    /// Resultants of the water on the whole bridge.
    pub(crate) water: [SparseRow; 3],
    pub(crate) held: Vec<HeldDof>,
    /// Upward forces at rest `[N]`: of what lies on the bridge, and of water that has risen by 1 m.
    pub(crate) dead_n: [SparseRow; 2],
    /// Resultants of what lies on the bridge, and of water that has risen by 1 m, as of [`Bridge::water`].
    pub(crate) dead_resultants: [f64; 3],
    pub(crate) risen_water: [f64; 3],
    /// Those of water that dry weights bring about beside what the dofs tell.
    pub(crate) dry_water: [f64; 3],
    /// The pins, joint after joint.
    pub(crate) pins: Vec<PinPlace>,
    /// Surge, sway and yaw of the whole bridge; motions of the bridge where no support holds them.
    pub(crate) horizontal_rigid: [Vec<f64>; 3],
    /// What stands at each place of the row.
    pub(crate) modules: Vec<ModulePlace>,
    /// Dofs of the deck's z: `[module][ix][iy]`, with the lines across they lie on.
    pub(super) deck_z: Vec<Vec<Vec<usize>>>,
    pub(super) lines_y: Vec<f64>,
}

impl Bridge {
    /// Assembles the bridge from one prepared module, of which all its modules are.
    ///
    /// # Errors
    /// As [`Bridge::of_kinds`].
    pub fn new(design: &BridgeDesign, module: &PreparedModule, ends: Ends) -> Result<Self, BridgeError> {
        Self::of_kinds(design, &[module], ends)
    }

    /// Assembles the bridge from the prepared modules of its [`BridgeDesign::variants`], see
    /// [`PreparedModule::of_kinds`].
    ///
    /// # Errors
    /// [`BridgeError`]; a module whose mesh does not span the design's, has no line at one of its hinges or connectors, or other
    /// lines across than its neighbours is refused.
    pub fn of_kinds<M: Borrow<PreparedModule>>(
        design: &BridgeDesign,
        prepared: &[M],
        ends: Ends,
    ) -> Result<Self, BridgeError> {
        if design.water.as_ref().is_some_and(|water| water.radiation.is_none()) {
            let allowed = "a water file that is there: what moves in water with memory needs it";
            return Err(InvalidInput::new("water.file", "a water that was not read", allowed).into());
        }
        let modules = Modules::new(design, prepared)?;
        let row = Row::number(design, &modules, ends);
        let places = Places {
            design,
            modules: &modules,
            row: &row,
        };
        let mut links = places.connectors();
        let joint_connectors = links.len();
        let springs = match ends {
            Ends::Supported => bank_springs(&design.banks, design.modules, |bank| design.bank_places_y_m(bank)),
            Ends::Free => Vec::new(),
        };
        let (one_sided, held): (Vec<_>, Vec<_>) = springs.into_iter().partition(|spring| spring.one_sided);
        links.extend(one_sided.iter().map(|spring| places.bank_link(spring)));
        let springs: Vec<SpringPlace> = held.iter().map(|spring| places.spring(spring)).collect();
        let mut k = row.entries(|module| &module.k);
        for SpringPlace { stiffness_n_m, row, .. } in &springs {
            for &(i, a) in &row.0 {
                k.extend(row.0.iter().map(|&(j, b)| (i, j, stiffness_n_m * a * b)));
            }
        }
        let dead = DeadLoads::new(design, &modules, &row);
        let mut m = row.entries(|module| &module.m);
        let masses = dead.masses().iter();
        let masses: Vec<(f64, SparseRow)> = masses
            .flat_map(|mass| mass.rows.iter().map(|row| (mass.mass_kg, row.clone())))
            .collect();
        for (mass_kg, row) in &masses {
            for &(i, a) in &row.0 {
                m.extend(row.0.iter().map(|&(j, b)| (i, j, mass_kg * a * b)));
            }
        }
        let radiation = design.water.as_ref().and_then(|water| water.radiation.as_ref());
        let waves = radiation.map(|radiation| BridgeWaves::new(radiation, &modules, &row));
        let mut times_m = ModuleProduct::new(&modules, &row, |module| &module.m).with(masses);
        if let Some(waves) = &waves {
            m.extend(waves.entries(waves.radiation.infinite()));
            times_m = times_m.coupled(&waves.motions, waves.radiation.infinite());
        }
        let in_k = springs
            .iter()
            .map(|spring| (spring.stiffness_n_m, spring.row.clone()))
            .collect();
        Ok(Self {
            design: design.clone(),
            model: modules.model(),
            k: SymmetricMatrix::from_entries(row.dofs, &k)?,
            m: SymmetricMatrix::from_entries(row.dofs, &m)?,
            times_k: ModuleProduct::new(&modules, &row, |module| &module.k).with(in_k),
            times_m,
            times_k_water: ModuleProduct::new(&modules, &row, |module| &module.k_water),
            links,
            joint_connectors,
            springs,
            positions: places.positions(),
            centre_line: places.centre_line(),
            edges: places.edges(),
            deck_corners: places.deck_corners(),
            bottom_corners: places.wet_corners(),
            corners: places.corners(),
            rolls: places.rolls(),
            trims: places.trims(),
            sections: places.sections(),
            hinge_lines: places.hinge_lines(),
            water: std::array::from_fn(|which| row.water_resultant(which)),
            held: row.held(|module, dof| dead.at(module, dof)),
            dead_n: dead.on_bridge(&row),
            dead_resultants: dead.resultants,
            risen_water: dead.risen_water,
            dry_water: dead.dry_water,
            pins: pins(design, &modules, &row, &places.deck_z(), (&dead, waves.as_ref())),
            waves,
            horizontal_rigid: row.horizontal_rigid(),
            deck_z: places.deck_z(),
            lines_y: modules.lines_y().to_vec(),
            modules: ModulePlace::all(design, &modules),
        })
    }

    /// The design it was built from.
    pub fn design(&self) -> &BridgeDesign {
        &self.design
    }

    /// Which matrices its modules contributed.
    pub fn model(&self) -> Model {
        self.model
    }

    /// Degrees of freedom.
    pub fn dofs(&self) -> usize {
        self.k.order()
    }

    /// Least draft of a module `[m]`; none where no module has one.
    pub(crate) fn least_draft_m(&self) -> Option<f64> {
        self.modules.iter().filter_map(|module| module.draft_m).reduce(f64::min)
    }

    /// Least freeboard of a module `[m]`; none where no module has one.
    pub(crate) fn least_freeboard_m(&self) -> Option<f64> {
        self.modules
            .iter()
            .filter_map(|module| module.freeboard_m)
            .reduce(f64::min)
    }

    /// Whether a motion from a dead state lifts a corner of the wet part of a module's bottom above the water; none where no module
    /// has a draft.
    pub(crate) fn bottom_emerges(&self, u: &[f64], dead: Option<&DeadState>) -> Option<bool> {
        passes(
            &self.modules,
            |module| module.draft_m,
            &self.bottom_corners,
            |i, row| row.dot(u) + dead.map_or(0.0, |dead| dead.bottom_corners_m[i]),
        )
    }

    /// Whether a motion from a dead state takes a corner of a module's deck below the water; none where no module has a freeboard.
    pub(crate) fn deck_submerges(&self, u: &[f64], dead: Option<&DeadState>) -> Option<bool> {
        passes(
            &self.modules,
            |module| module.freeboard_m,
            &self.deck_corners,
            |i, row| -row.dot(u) - dead.map_or(0.0, |dead| dead.deck_corners_m[i]),
        )
    }

    /// The springs of all banks, bank after bank.
    pub(crate) fn bank_parts(&self) -> Vec<BankPart> {
        let links = self.links.iter().enumerate();
        let links = links.filter_map(|(link, of)| match of.place {
            LinkPlace::Connector { .. } => None,
            LinkPlace::Bank { bank, y_m } => Some(BankPart {
                bank,
                y_m,
                source: BankSource::Link(link),
            }),
        });
        let springs = self.springs.iter().enumerate();
        let springs = springs.map(|(index, spring)| BankPart {
            bank: spring.bank,
            y_m: spring.y_m,
            source: BankSource::Spring(index, spring.stiffness_n_m),
        });
        let mut parts: Vec<BankPart> = links.chain(springs).collect();
        parts.sort_by_key(|part| part.bank);
        parts
    }

    /// Where the force of a bank's spring acts upward; none of a bank that holds along or across, and of a connector.
    pub(crate) fn vertical_bank(&self, place: LinkPlace) -> Option<UpwardForce> {
        let LinkPlace::Bank { bank, y_m } = place else {
            return None;
        };
        let spec = self
            .design
            .banks
            .get(bank)
            .filter(|spec| spec.direction == Direction::Z)?;
        Some(UpwardForce {
            x_m: self.design.position_x_m(spec.position(self.design.modules)),
            y_m,
            sense: spec.sense(self.design.modules),
        })
    }

    /// z of the bottom's centre line at a place on the bridge, linear between two stations; at a joint that of its position.
    pub(crate) fn place(&self, x_m: f64) -> SparseRow {
        let line = &self.centre_line;
        let behind = line.partition_point(|(x, _)| *x <= x_m);
        let first = behind.saturating_sub(1).min(line.len() - 2);
        let [(x0, left), (x1, right)] = [&line[first], &line[first + 1]];
        let share = if x1 > x0 {
            ((x_m - x0) / (x1 - x0)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        SparseRow::combine(&[(1.0 - share, left), (share, right)])
    }
}

/// Whether one of the four corners of a module goes farther than its limit; none where no module has one.
fn passes(
    modules: &[ModulePlace],
    limit: impl Fn(&ModulePlace) -> Option<f64>,
    corners: &[SparseRow],
    way: impl Fn(usize, &SparseRow) -> f64,
) -> Option<bool> {
    let limited = || {
        modules
            .iter()
            .zip(corners.chunks_exact(4))
            .enumerate()
            .filter_map(|(j, (m, rows))| Some((limit(m)?, 4 * j, rows)))
    };
    limited().next()?;
    Some(limited().any(|(limit_m, first, rows)| (first..).zip(rows).any(|(i, row)| way(i, row) > limit_m)))
}

/// Where a numbered row of modules is loaded and read: makes the rows of the bridge's dofs for places along it.
///
/// A station is a module with one of its lines along, `(j, ix)`.
struct Places<'a> {
    design: &'a BridgeDesign,
    modules: &'a Modules<'a>,
    row: &'a Row<'a>,
}

impl Places<'_> {
    /// Gives a node's translation in module `j` in terms of the bridge's dofs.
    fn of(&self, j: usize, node: NodeId, direction: usize) -> SparseRow {
        self.row.global(j, &self.modules.module(j).row(node, direction))
    }

    /// Gives z at the bottom's centre line of a station.
    fn centre(&self, j: usize, ix: usize) -> SparseRow {
        let grid = self.modules.grid(j);
        let rows: Vec<(f64, SparseRow)> = grid
            .centre()
            .into_iter()
            .map(|(weight, iy)| (weight, self.of(j, grid.bottom(ix, iy), Z)))
            .collect();
        SparseRow::combine(&rows.iter().map(|(w, row)| (*w, row)).collect::<Vec<_>>())
    }

    /// Lists the stations, module after module.
    fn stations(&self) -> impl Iterator<Item = (usize, usize)> {
        let modules = self.modules.each().enumerate();
        modules.flat_map(|(j, module)| (0..module.grid.x.len()).map(move |ix| (j, ix)))
    }

    /// Lists the stations at the modules' ends, each module's left one first.
    fn ends(&self) -> impl Iterator<Item = (usize, usize)> {
        let modules = self.modules.each().enumerate();
        modules.flat_map(|(j, module)| [Side::Left, Side::Right].map(|side| (j, module.end_line(side))))
    }

    /// Gives the place of a station along the bridge `[m]`.
    fn x_m(&self, j: usize, ix: usize) -> f64 {
        self.modules.left_m(j) + self.modules.grid(j).x[ix]
    }

    /// Gives the position of that end of its module to which a station is nearer; in the middle the left one's.
    fn nearer_position(&self, j: usize, ix: usize) -> usize {
        let x = &self.modules.grid(j).x;
        let is_right = x[ix] - 0.5 * x[x.len() - 1] > SAME_PLACE_M;
        j + 1 + usize::from(is_right)
    }

    /// Makes the connectors, joint after joint.
    fn connectors(&self) -> Vec<LinkRow> {
        let mut connectors = Vec::new();
        for j in 1..self.modules.len() {
            let [left, right] = [j - 1, j].map(|j| self.modules.grid(j));
            let ends_m = [(j - 1, Side::Right), (j, Side::Left)].map(|(j, side)| self.modules.depth_m(j, side));
            let height_m = ends_m[0].min(ends_m[1]);
            for &y_m in &self.design.connectors.y_m {
                if let (Some(left_iy), Some(right_iy)) = (left.y_line(y_m), right.y_line(y_m)) {
                    let left = self.at_height(j - 1, (Side::Right, left_iy), height_m);
                    let right = self.at_height(j, (Side::Left, right_iy), height_m);
                    connectors.push(LinkRow {
                        place: LinkPlace::Connector {
                            number: connectors.len() + 1,
                            joint: j + 1,
                            y_m,
                        },
                        row: SparseRow::combine(&[(-1.0, &left), (1.0, &right)]),
                    });
                }
            }
        }
        connectors
    }

    /// Gives the motion along the bridge of a module's end at a height: of its deck, or lower down linear between bottom and
    /// deck, so that two ends that turn together have no elongation between them.
    fn at_height(&self, j: usize, (side, iy): (Side, usize), height_m: f64) -> SparseRow {
        let (grid, ix) = (self.modules.grid(j), self.modules.module(j).end_line(side));
        let depth_m = self.modules.depth_m(j, side);
        let deck = self.of(j, grid.deck(ix, iy), X);
        if depth_m - height_m <= SAME_PLACE_M {
            return deck;
        }
        let share = height_m / depth_m;
        let bottom = self.of(j, grid.bottom(ix, iy), X);
        SparseRow::combine(&[(share, &deck), (1.0 - share, &bottom)])
    }

    /// Makes the row of a bank's spring: the motion of its node along its sense.
    fn bank_row(&self, spring: &BankSpring) -> SparseRow {
        let last = self.modules.len();
        let (j, side) = if spring.position > last {
            (last - 1, Side::Right)
        } else {
            (spring.position - 1, Side::Left)
        };
        let (grid, ix) = (self.modules.grid(j), self.modules.module(j).end_line(side));
        let direction = match spring.direction {
            Direction::X => X,
            Direction::Y => Y,
            Direction::Z => Z,
        };
        let along = grid
            .y_line(spring.y_m)
            .map(|iy| self.of(j, grid.bottom(ix, iy), direction));
        SparseRow::combine(&[(spring.sign, &along.unwrap_or_default())])
    }

    /// Makes the link of a spring that acts in one sense alone.
    fn bank_link(&self, spring: &BankSpring) -> LinkRow {
        LinkRow {
            place: LinkPlace::Bank {
                bank: spring.bank,
                y_m: spring.y_m,
            },
            row: self.bank_row(spring),
        }
    }

    /// Makes the place of a spring that holds both ways.
    fn spring(&self, spring: &BankSpring) -> SpringPlace {
        SpringPlace {
            bank: spring.bank,
            y_m: spring.y_m,
            stiffness_n_m: spring.stiffness_n_m,
            row: self.bank_row(spring),
        }
    }

    /// Makes the rows of [`Bridge::positions`]: the left end of each module, and the right end of the last.
    fn positions(&self) -> Vec<SparseRow> {
        let last = self.modules.len() - 1;
        let mut positions: Vec<SparseRow> = (0..=last).map(|j| self.centre(j, 0)).collect();
        positions.push(self.centre(last, self.modules.grid(last).x.len() - 1));
        positions
    }

    /// Makes the rows of [`Bridge::centre_line`], each with its place along `[m]`.
    fn centre_line(&self) -> Vec<(f64, SparseRow)> {
        self.stations()
            .map(|(j, ix)| (self.x_m(j, ix), self.centre(j, ix)))
            .collect()
    }

    /// Makes the rows of [`Bridge::edges`], station after station, the edge at the lowest y first.
    fn edges(&self) -> Vec<(usize, SparseRow)> {
        let last = self.modules.lines_y().len() - 1;
        self.stations()
            .flat_map(|station| [(station, 0), (station, last)])
            .map(|((j, ix), iy)| {
                let z = self.of(j, self.modules.grid(j).deck(ix, iy), Z);
                (self.nearer_position(j, ix), z)
            })
            .collect()
    }

    /// Makes the rows of [`Bridge::deck_corners`]: those of a module's left end first.
    fn deck_corners(&self) -> Vec<SparseRow> {
        self.edges_at(self.ends(), Grid::deck)
    }

    /// Makes the rows of [`Bridge::bottom_corners`], those of the wet part's left end first; of a dry module those of its own.
    fn wet_corners(&self) -> Vec<SparseRow> {
        let of_module = |j: usize| {
            let (grid, design) = (self.modules.grid(j), self.modules.design(j));
            let ends = if design.is_dry() {
                [Some(0), None]
            } else {
                design.wet_m().map(|x_m| grid.x_line(x_m))
            };
            [(j, ends[0].unwrap_or(0)), (j, ends[1].unwrap_or(grid.x.len() - 1))]
        };
        self.edges_at((0..self.modules.len()).flat_map(of_module), Grid::bottom)
    }

    /// Makes the rows of z at both edges of stations; `node` is [`Grid::deck`] or [`Grid::bottom`].
    fn edges_at(
        &self,
        stations: impl Iterator<Item = (usize, usize)>,
        node: fn(&Grid, usize, usize) -> NodeId,
    ) -> Vec<SparseRow> {
        let last = self.modules.lines_y().len() - 1;
        stations
            .flat_map(|station| [(station, 0), (station, last)])
            .map(|((j, ix), iy)| self.of(j, node(self.modules.grid(j), ix, iy), Z))
            .collect()
    }

    /// Makes the rows of [`Bridge::corners`]: of each module the four at the bottom, then the four at the deck, each time
    /// around.
    fn corners(&self) -> Vec<[SparseRow; 3]> {
        (0..self.modules.len())
            .flat_map(|j| {
                let grid = self.modules.grid(j);
                let (nx, ny) = (grid.x.len(), grid.y.len());
                let around = [(0, 0), (nx - 1, 0), (nx - 1, ny - 1), (0, ny - 1)];
                let bottom = around.map(|(ix, iy)| grid.bottom(ix, iy));
                let deck = around.map(|(ix, iy)| grid.deck(ix, iy));
                bottom.into_iter().chain(deck).map(move |node| (j, node))
            })
            .map(|(j, node)| [X, Y, Z].map(|direction| self.of(j, node, direction)))
            .collect()
    }

    /// Makes the rows of [`Bridge::rolls`]: z of the deck's two edges over the breadth.
    fn rolls(&self) -> Vec<(usize, SparseRow)> {
        self.ends()
            .map(|(j, ix)| {
                let grid = self.modules.grid(j);
                let right = self.of(j, grid.deck(ix, 0), Z);
                let left = self.of(j, grid.deck(ix, grid.y.len() - 1), Z);
                let per = 1.0 / self.design.module.breadth_m;
                let row = SparseRow::combine(&[(-per, &right), (per, &left)]);
                (self.nearer_position(j, ix), row)
            })
            .collect()
    }

    /// Makes the rows of [`Bridge::trims`]: the mean z of the deck's corners at the right end less that at the left one, over the
    /// length.
    fn trims(&self) -> Vec<SparseRow> {
        let corners = self.deck_corners();
        let modules = (0..).zip(corners.chunks_exact(4));
        let trim = |(j, corners): (usize, &[SparseRow])| {
            let half = 0.5 / self.modules.design(j).module.length_m;
            let signs = [-half, -half, half, half];
            SparseRow::combine(&signs.into_iter().zip(corners).collect::<Vec<_>>())
        };
        modules.map(trim).collect()
    }

    /// Makes the rows of [`Bridge::sections`], each with its place along and across `[m]`.
    fn sections(&self) -> Vec<(f64, Vec<(f64, SparseRow)>)> {
        self.stations()
            .map(|(j, ix)| {
                let grid = self.modules.grid(j);
                let row = |iy: usize| (grid.y[iy], self.of(j, grid.deck(ix, iy), Z));
                (self.x_m(j, ix), (0..grid.y.len()).map(row).collect())
            })
            .collect()
    }

    /// Makes the rows of [`Bridge::hinge_lines`], each pair with its place along `[m]`.
    fn hinge_lines(&self) -> Vec<(f64, SparseRow, SparseRow)> {
        self.ends()
            .map(|(j, ix)| {
                let grid = self.modules.grid(j);
                let hinges = self.design.hinges.y_m.iter().filter_map(|&y| grid.y_line(y));
                let hinges: Vec<usize> = hinges.collect();
                let mean = |direction: usize| {
                    let rows: Vec<SparseRow> = hinges
                        .iter()
                        .map(|&iy| self.of(j, grid.bottom(ix, iy), direction))
                        .collect();
                    let share = 1.0 / rows.len() as f64;
                    SparseRow::combine(&rows.iter().map(|r| (share, r)).collect::<Vec<_>>())
                };
                (self.x_m(j, ix), mean(X), mean(Y))
            })
            .collect()
    }

    /// Lists the dofs of the deck's z, `[module][ix][iy]`.
    fn deck_z(&self) -> Vec<Vec<Vec<usize>>> {
        let of_module = |j: usize| {
            let grid = self.modules.grid(j);
            let node = |ix: usize, iy: usize| self.row.direct(j, grid.deck(ix, iy), Z);
            let line = |ix: usize| (0..grid.y.len()).map(|iy| node(ix, iy)).collect();
            (0..grid.x.len()).map(line).collect()
        };
        (0..self.modules.len()).map(of_module).collect()
    }
}
