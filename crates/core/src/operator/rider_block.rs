//! What rides along, as the contact system sees it: one dense block of rows for vehicles at one place.
//!
//! Knows rows on riders and on links, which hang on places alone, and what lanes have of their own. Does not know what rides or what
//! a link is.

use super::lane_array::LaneArray;

/// The rows of riders, each measured in displacement: `A q' + A_links N' = free`, q' and N' the scaled forces of riders and links;
/// links see `A_on q'` of the riders.
/// Equation (C1).
#[derive(Debug)]
pub(super) struct RiderBlock {
    riders: usize,
    links: usize,
    symmetric: bool,
    among: Vec<f64>,
    of_links: Vec<f64>,
    on_links: Vec<f64>,
    /// What each lane has beside: on the diagonal of A, and among the riders from `first_beside` on.
    pub(super) own: LaneArray,
    pub(super) beside: LaneArray,
    first_beside: usize,
    /// The riders' measures without new forces.
    pub(super) free: LaneArray,
}

/// One rider's row, to be written.
#[derive(Debug)]
pub(super) struct RiderRow<'a> {
    /// What it sees of riders and of links.
    pub among: &'a mut [f64],
    pub of_links: &'a mut [f64],
    /// What links see of it; empty where that is what it sees of them.
    pub on_links: &'a mut [f64],
}

impl RiderBlock {
    /// Room for so many riders beside so many links.
    pub(super) fn new(riders: usize, links: usize, lanes: usize) -> Self {
        Self {
            riders: 0,
            links,
            symmetric: true,
            among: vec![0.0; riders * riders],
            of_links: vec![0.0; riders * links],
            on_links: vec![0.0; riders * links],
            own: LaneArray::new(riders, lanes),
            beside: LaneArray::new(riders * riders, lanes),
            first_beside: 0,
            free: LaneArray::new(riders, lanes),
        }
    }

    /// Begins a block of zeros; a symmetric one sees of links what they see of it. Lanes have something beside from a rider on.
    #[inline(always)]
    pub(super) fn begin(&mut self, riders: usize, symmetric: bool, first_beside: usize) {
        (self.riders, self.symmetric, self.first_beside) = (riders, symmetric, first_beside);
        self.among[..riders * riders].fill(0.0);
        self.of_links[..riders * self.links].fill(0.0);
        if !symmetric {
            self.on_links[..riders * self.links].fill(0.0);
        }
        let many = riders - first_beside;
        self.beside.clear_rows(many * many);
    }

    /// A rider's row, to be written.
    #[inline(always)]
    pub(super) fn row_mut(&mut self, i: usize) -> RiderRow<'_> {
        let on_links = if self.symmetric { 0 } else { self.links };
        RiderRow {
            among: &mut self.among[i * self.riders..][..self.riders],
            of_links: &mut self.of_links[i * self.links..][..self.links],
            on_links: &mut self.on_links[i * self.links..][..on_links],
        }
    }

    /// Row of what lanes have beside between two riders; none where they have nothing.
    #[inline(always)]
    pub(super) fn beside_at(&self, i: usize, j: usize) -> Option<usize> {
        let (i, j) = (i.checked_sub(self.first_beside)?, j.checked_sub(self.first_beside)?);
        Some(i * (self.riders - self.first_beside) + j)
    }

    /// Adds to the measure of each rider what it sees of scaled forces of links, in one lane.
    pub(super) fn add_links(&mut self, lane: usize, scaled: &[f64]) {
        for i in 0..self.riders {
            let of_links = &self.of_links[i * self.links..][..self.links];
            *self.free.at_mut(i, lane) += of_links
                .iter()
                .zip(scaled)
                .map(|(seen, force)| seen * force)
                .sum::<f64>();
        }
    }

    /// Number of riders.
    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        self.riders
    }

    /// Whether what a rider sees of another, or of a link, is what that one sees of it.
    #[inline(always)]
    pub(super) fn symmetric(&self) -> bool {
        self.symmetric
    }

    /// What a rider sees of the riders.
    #[inline(always)]
    pub(super) fn among(&self, i: usize) -> &[f64] {
        &self.among[i * self.riders..][..self.riders]
    }

    /// What a rider sees of the links.
    #[inline(always)]
    pub(super) fn of_links(&self, i: usize) -> &[f64] {
        &self.of_links[i * self.links..][..self.links]
    }

    /// What the links see of a rider.
    #[inline(always)]
    pub(super) fn on_links(&self, i: usize) -> &[f64] {
        if self.symmetric {
            return self.of_links(i);
        }
        &self.on_links[i * self.links..][..self.links]
    }
}
