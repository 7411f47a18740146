//! The three documents of a job - bridge, vehicle, analysis - after the axes, each distinct one read once.
//!
//! Knows how an axis changes a document and shares what is equal. Does not know what a job asks of them.

use super::crossing_type::CrossingType;
use crate::design::{DesignPoint, JobAxis, Root};
use crate::input::{Cell, DocumentPath, Refusal, RefusalKind, canonical_text, join, to_value, typed_value};
use crate::study_file::{Analysis, Study, WearSpec, at_home, filled_vehicle};
use crate::water_file::BridgeWater;
use pontoon_core::bridge::{BankSpec, BridgeDesign, DeadSpec, Joints, Supports, WaterSpec};
use pontoon_core::input::InvalidInput;
use pontoon_core::road::{Road, RoadDesign, Ways};
use pontoon_core::traffic::{Deck, Driven, StudyVehicle, Traffic, TrafficDesign};
use pontoon_core::vehicle::{Vehicle, VehicleDesign};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// A bridge after the axes.
#[derive(Debug)]
pub struct BridgeEntry {
    /// Its number, from 0, in the order of first use.
    pub id: usize,
    /// Its design.
    pub design: BridgeDesign,
    /// Its water with memory, where it names one and the file was read.
    pub water: Option<Arc<BridgeWater>>,
    /// The design as a document, defaults filled in.
    pub document: Value,
    /// Hash of the document.
    pub hash: String,
    /// Equal for bridges that differ in nothing but gaps, dashpots, what joints have of their own connectors (data of a job) and
    /// words.
    pub structure_key: Arc<str>,
    /// Equal for bridges that have one operator: the connectors' stiffness is no part of it either.
    pub operator_key: Arc<str>,
    /// One for each of the design's variants, in their order; equal for modules that are equal: neither are the connectors'
    /// stiffness, the number of modules, the supports and the other kinds part of a module.
    pub module_keys: Vec<Arc<str>>,
}

/// A vehicle after the axes, checked on a deck.
#[derive(Debug)]
pub struct VehicleEntry {
    /// Its number, from 0, in the order of first use.
    pub id: usize,
    /// The vehicle.
    pub vehicle: Arc<Vehicle>,
    /// Its design.
    pub design: VehicleDesign,
    /// Its design as a document, defaults filled in.
    pub document: Value,
    /// Equal for vehicles that are equal, whatever study they are of.
    pub key: Arc<str>,
}

/// An analysis after the axes.
#[derive(Debug)]
pub struct AnalysisEntry {
    /// Its number, from 0, in the order of first use.
    pub id: usize,
    /// The analysis.
    pub analysis: Analysis,
    /// The analysis as a document, defaults filled in.
    pub document: Value,
    /// Equal for analyses that are equal, whatever study they are of.
    pub key: Arc<str>,
}

/// The wear of joints after the axes.
#[derive(Debug)]
pub struct WearEntry {
    /// How gaps scatter.
    pub wear: WearSpec,
    /// The document that it comes to, as columns show it.
    pub document: Value,
}

/// Several vehicles or a road after the axes.
#[derive(Debug)]
pub struct TrafficEntry {
    /// What drives.
    pub traffic: Traffic,
    /// Whether that is the study's own vehicle alone.
    pub is_single: bool,
    /// The document that it comes to, as columns show it.
    pub document: Value,
    /// Equal for traffics that are equal, whatever study they are of.
    pub key: [u8; 32],
}

impl TrafficEntry {
    /// A number that all vehicles have alike.
    pub(super) fn common(&self, number: impl Fn(&Driven) -> f64) -> Option<f64> {
        let mut numbers = self.traffic.vehicles.iter().map(number);
        let first = numbers.next()?;
        numbers.all(|other| other == first).then_some(first)
    }
}

/// The documents read so far.
#[derive(Debug, Clone, Default)]
pub(super) struct Documents {
    /// Roads by their documents and ways.
    roads: HashMap<String, Arc<Road>>,
    bridges: Interned<BridgeEntry>,
    vehicles: Interned<VehicleEntry>,
    analyses: Interned<AnalysisEntry>,
    wears: Interned<WearEntry>,
}

/// What was asked for: the text of the changes, nothing where there are none, and bits of what else they are read with.
type DocumentRequest = (u64, Option<String>);

/// Entries by what was asked for, then by what it came to: two ways of writing the same share one entry.
#[derive(Debug)]
struct Interned<T> {
    /// What was asked for last: most points of a study ask for the same as the one before.
    last: Option<(DocumentRequest, Arc<T>)>,
    asked: HashMap<DocumentRequest, Arc<T>>,
    distinct: HashMap<String, Arc<T>>,
}

impl<T> Clone for Interned<T> {
    fn clone(&self) -> Self {
        Self {
            last: self.last.clone(),
            asked: self.asked.clone(),
            distinct: self.distinct.clone(),
        }
    }
}

impl<T> Default for Interned<T> {
    fn default() -> Self {
        Self {
            last: None,
            asked: HashMap::new(),
            distinct: HashMap::new(),
        }
    }
}

impl<T> Interned<T> {
    /// The entry for `asked`; `make` reads it and gives its text, `build` makes the entry of a text not seen before.
    fn get<D>(
        &mut self,
        asked: DocumentRequest,
        make: impl FnOnce() -> Result<(String, D), Refusal>,
        build: impl FnOnce(usize, D) -> T,
    ) -> Result<Arc<T>, Refusal> {
        if let Some((_, entry)) = self.last.as_ref().filter(|(last, _)| *last == asked) {
            return Ok(Arc::clone(entry));
        }
        let entry = match self.asked.get(&asked) {
            Some(entry) => Arc::clone(entry),
            None => {
                let (text, made) = make()?;
                let id = self.distinct.len();
                let entry = self.distinct.entry(text).or_insert_with(|| Arc::new(build(id, made)));
                self.asked.insert(asked.clone(), Arc::clone(entry));
                Arc::clone(entry)
            }
        };
        self.last = Some((asked, Arc::clone(&entry)));
        Ok(entry)
    }
}

impl Documents {
    /// The bridge of a point.
    pub(super) fn bridge(&mut self, study: &Study, point: &DesignPoint<'_>) -> Result<Arc<BridgeEntry>, Refusal> {
        let changes = Changes::of(study, point, Root::Bridge);
        let read = || {
            let design = match changes.applied(&study.bridge.design)? {
                None => (study.bridge.design.clone(), study.bridge.water.clone()),
                Some(mut design) => {
                    let checked = design.check().and_then(|()| design.check_water_line());
                    checked.map_err(|e| changes.refusal(e))?;
                    let water = changed_water(study, &mut design).map_err(|refusal| changes.placed(refusal))?;
                    (design, water)
                }
            };
            let (design, water) = design;
            let document = to_value(&design);
            Ok((canonical_text(&document), (design, water, document)))
        };
        self.bridges
            .get((0, changes.text()), read, |id, (design, water, document)| {
                bridge_entry(id, (design, water), document)
            })
    }

    /// The vehicle of a point on the deck of `bridge`.
    pub(super) fn vehicle(
        &mut self,
        study: &Study,
        point: &DesignPoint<'_>,
        bridge: &BridgeEntry,
    ) -> Result<Arc<VehicleEntry>, Refusal> {
        let changes = Changes::of(study, point, Root::Vehicle);
        let breadth_m = bridge.design.module.breadth_m;
        let (place, written) = match point.of_job(JobAxis::Vehicle) {
            None => ("vehicle".to_owned(), &study.vehicle),
            Some(cell) => {
                let path = format!("{}.vehicle", point.key());
                let name = cell.word().unwrap_or_default();
                let named = study.vehicles.get(name).ok_or_else(|| {
                    let refused = Refusal::new(&study.file, path, &cell.value(), "the name or the file of a vehicle");
                    refused.because(RefusalKind::WrongType)
                })?;
                (format!("vehicles.{name}"), named)
            }
        };
        let asked = changes
            .text()
            .map(|text| format!("{place};{text}"))
            .or((place != "vehicle").then(|| place.clone()));
        let read = || {
            // the defaults of the single footprint can be changed in part, unless axles take its place
            let axles = changes.list.iter().any(|(_, path, _)| path.begins_with("axles"));
            let filled = filled_vehicle(written).ok().filter(|_| !axles);
            let base = filled.as_ref().unwrap_or(written);
            let changed = changes.applied(base)?;
            let refusal = |e: InvalidInput| match changes.list.is_empty() {
                true => at_home(&study.vehicle_files, Refusal::of(&study.file, &place, e)),
                false => changes.refusal(e),
            };
            let design = filled_vehicle(changed.as_ref().unwrap_or(base)).map_err(refusal)?;
            let vehicle = design.check(breadth_m).map_err(refusal)?;
            let document = to_value(&design);
            Ok((canonical_text(&document), (vehicle, design, document)))
        };
        self.vehicles
            .get((breadth_m.to_bits(), asked), read, |id, (vehicle, design, document)| {
                VehicleEntry {
                    id,
                    vehicle: Arc::new(vehicle),
                    design,
                    key: canonical_text(&document).into(),
                    document,
                }
            })
    }

    /// The analysis of a point.
    pub(super) fn analysis(&mut self, study: &Study, point: &DesignPoint<'_>) -> Result<Arc<AnalysisEntry>, Refusal> {
        let changes = Changes::of(study, point, Root::Analysis);
        let read = || {
            let analysis = match changes.applied(&study.analysis_written)? {
                None => study.analysis,
                Some(written) => Analysis::of(&written).map_err(|e| changes.refusal(e))?,
            };
            let document = to_value(&analysis.written());
            Ok((canonical_text(&document), (analysis, document)))
        };
        self.analyses
            .get((0, changes.text()), read, |id, (analysis, document)| AnalysisEntry {
                id,
                analysis,
                key: blake3::hash(canonical_text(&document).as_bytes())
                    .to_hex()
                    .as_str()
                    .into(),
                document,
            })
    }
}

impl Documents {
    /// The traffic of a point; none where one vehicle crosses a level road as the study itself says.
    pub(super) fn traffic(
        &mut self,
        study: &Study,
        point: &DesignPoint<'_>,
        (bridge, vehicle): (&BridgeEntry, &VehicleEntry),
        ([load_n, speed_m_s], crossing_type): ([Option<f64>; 2], Option<CrossingType>),
    ) -> Result<Option<Arc<TrafficEntry>>, Refusal> {
        let changes = Changes::of(study, point, Root::Traffic);
        if study.traffic == TrafficDesign::default() && changes.list.is_empty() && crossing_type.is_none() {
            return Ok(None);
        }
        let deck = Deck {
            length_m: bridge.design.length_m(),
            breadth_m: bridge.design.module.breadth_m,
        };
        let mut changed = changes.applied(&study.traffic)?;
        if let Some(of) = crossing_type {
            let design = changed.get_or_insert_with(|| study.traffic.clone());
            design.column = Some(of.column(&vehicle.vehicle, deck.length_m));
        }
        let design = changed.as_ref().unwrap_or(&study.traffic);
        let of_study = StudyVehicle {
            design: &vehicle.design,
            load_n,
            speed_m_s,
        };
        let roads = &mut self.roads;
        let make_road = |design: &RoadDesign, ways: &Ways<'_>| {
            let key = format!("{}{ways:?}", canonical_text(&to_value(design)));
            if let Some(road) = roads.get(&key) {
                return Ok(Arc::clone(road));
            }
            let road = Arc::new(design.road(ways)?);
            roads.insert(key, Arc::clone(&road));
            Ok(road)
        };
        let traffic = design.traffic_on(of_study, deck, make_road);
        let traffic = traffic.map_err(|e| at_home(&study.vehicle_files, changes.refusal(e)))?;
        let document = to_value(design);
        let mut hasher = blake3::Hasher::new();
        hasher.update(canonical_text(&document).as_bytes());
        // what entries leave to the study
        hasher.update(vehicle.key.as_bytes());
        for number in [load_n, speed_m_s] {
            hasher.update(&number.map_or(u64::MAX, f64::to_bits).to_le_bytes());
        }
        Ok(Some(Arc::new(TrafficEntry {
            traffic,
            is_single: design.is_single(),
            document,
            key: *hasher.finalize().as_bytes(),
        })))
    }

    /// The wear of a point; none where its study has none.
    pub(super) fn wear(&mut self, study: &Study, point: &DesignPoint<'_>) -> Result<Option<Arc<WearEntry>>, Refusal> {
        let changes = Changes::of(study, point, Root::Wear);
        if study.wear.is_none() && changes.list.is_empty() {
            return Ok(None);
        }
        let read = || {
            let base = study.wear.unwrap_or_default();
            let wear = changes.applied(&base)?.unwrap_or(base);
            wear.check().map_err(|e| changes.refusal(e))?;
            let document = to_value(&wear);
            Ok((canonical_text(&document), (wear, document)))
        };
        let build = |_, (wear, document)| WearEntry { wear, document };
        self.wears.get((0, changes.text()), read, build).map(Some)
    }
}

/// The water of a bridge that axes have changed: another file has another hash than that of the bridge's own.
fn changed_water(study: &Study, design: &mut BridgeDesign) -> Result<Option<Arc<BridgeWater>>, Refusal> {
    let bridge = &study.bridge;
    if bridge.design.water.is_some() && bridge.water.is_none() {
        // a bridge of stored documents that was not given the waters beside them
        return Ok(None);
    }
    if let (Some(own), Some(base)) = (&mut design.water, &bridge.design.water)
        && own.file != base.file
    {
        own.blake3 = None;
    }
    bridge.waters.attach(&study.file, bridge.folder(), design)
}

fn bridge_entry(id: usize, (design, water): (BridgeDesign, Option<Arc<BridgeWater>>), document: Value) -> BridgeEntry {
    let hash_of = |document: &Value| blake3::hash(canonical_text(document).as_bytes()).to_hex();
    let hash = hash_of(&document).to_string();
    let mut neutral = design.without_words();
    neutral.connectors.gap_tension_m = 0.0;
    neutral.connectors.gap_compression_m = 0.0;
    neutral.connectors.damping_n_s_m = None;
    neutral.joints = design.joints.structure(design.modules, &design.hinges);
    neutral.banks = design.banks.iter().map(BankSpec::structure).collect();
    neutral.water_level_m = None;
    let structure_key = hash_of(&to_value(&neutral)).as_str().into();
    neutral.connectors.stiffness_n_m = 1.0;
    let operator_key = hash_of(&to_value(&neutral)).as_str().into();
    let module_key = |mut of_kind: BridgeDesign| {
        of_kind.modules = 1;
        of_kind.hinges.y_m = design.hinge_lines_y_m();
        of_kind.joints = Joints::default();
        of_kind.supports = Supports::default();
        of_kind.banks = Vec::new();
        of_kind.dead = DeadSpec::default();
        of_kind.draft_m = None;
        of_kind.freeboard_m = None;
        // a module is the same in all water with memory
        if let Some(water) = &mut of_kind.water {
            *water = WaterSpec::default();
        }
        hash_of(&to_value(&of_kind)).as_str().into()
    };
    neutral.joints = design.joints.clone();
    let module_keys = neutral.variants().designs.into_iter().map(module_key).collect();
    BridgeEntry {
        id,
        design,
        water,
        document,
        hash,
        structure_key,
        operator_key,
        module_keys,
    }
}

/// What the axes of a point change in one document.
struct Changes<'a> {
    file: &'a Path,
    point: &'a DesignPoint<'a>,
    root: Root,
    list: Vec<(&'a str, &'a DocumentPath, &'a Cell<'a>)>,
}

impl<'a> Changes<'a> {
    fn of(study: &'a Study, point: &'a DesignPoint<'a>, root: Root) -> Self {
        Self {
            file: &study.file,
            point,
            root,
            list: point.of_document(root).collect(),
        }
    }

    /// Equal for equal changes; nothing where there are none, as of most points of large studies.
    fn text(&self) -> Option<String> {
        let texts = self.list.iter().map(|(name, _, value)| format!("{name}={value};"));
        (!self.list.is_empty()).then(|| texts.collect())
    }

    /// A document with the changes; none where there are none.
    fn applied<T: Serialize + DeserializeOwned>(&self, base: &T) -> Result<Option<T>, Refusal> {
        if self.list.is_empty() {
            return Ok(None);
        }
        let mut document = to_value(base);
        for (name, path, value) in &self.list {
            path.set(&mut document, value.value()).map_err(|obstacle| {
                let allowed = format!("the path of a value in {}", self.root.described());
                let path = self.point.path_of(name);
                Refusal::new(self.file, path, obstacle.to_string(), allowed).because(RefusalKind::Misplaced)
            })?;
        }
        typed_value(self.file, "", &document)
            .map(Some)
            .map_err(|e| self.placed(e))
    }

    /// A refusal of a number of the changed document.
    fn refusal(&self, error: InvalidInput) -> Refusal {
        self.placed(Refusal::of(self.file, "", error))
    }

    /// The refusal with its path as the study file has it: at the axis that changed it, or at the block whose axes made
    /// another value wrong.
    /// A refusal of a file of its own stays there.
    fn placed(&self, refusal: Refusal) -> Refusal {
        if refusal.file != self.file {
            return refusal;
        }
        let path = join(self.root.word(), &refusal.path);
        if self.list.is_empty() {
            return Refusal { path, ..refusal };
        }
        let block = self.point.key();
        let refused = DocumentPath::parse(&refusal.path);
        let at_axis = |(name, of, _): &(&str, &DocumentPath, &Cell<'_>)| {
            let rest = of.beyond(refused.as_ref()?)?;
            Some(join(&self.point.path_of(name), &rest))
        };
        if let Some(path) = self.list.iter().find_map(at_axis) {
            return Refusal { path, ..refusal };
        }
        Refusal {
            path: block.into_owned(),
            made_wrong: Some(path.into()),
            ..refusal
        }
    }
}
