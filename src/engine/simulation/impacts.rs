//! The impacts of one rock: one row for every patch that it hits.
//!
//! A rock may hit several patches at once, or hit one while it is still pressed into another. Each
//! has its own approach speed, its own end and its own speed afterwards. While several are active,
//! impacts on trees share what trees take, and impacts on the slope share what the slope takes.
//! Each share is proportional to the square of the approach speed, that is, to the energy that the
//! approach brings. A patch that opens for an instant and closes again is still the same impact.
//!
//! Why a share by squares: two contacts hit at once are followed as one event, and what each took
//! by itself is not known. The energy `m (n·v)²/2` of an approach along its normal is known, and it
//! is what a dashpot takes from.

use super::Impact;
use crate::contact::MAX_CONTACTS;
use crate::contact::history::SAME_CONTACT_COSINE;
use crate::rock::Vec3;
use crate::solver::impact_point::ImpactPoint;

/// A patch hit again within this time after it has opened (s) is the same impact: its springs
/// opened for an instant, or the rock crossed the edge of a triangle.
///
/// Contact times are `π/ω`: 4 ms for a block of 1400 kg on 1e9 N/m, so a millisecond is short
/// against an impact and long against a step.
const SAME_IMPACT_S: f64 = 1e-3;

/// Energy by owner of the mesh (J).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct MeshEnergy {
    /// The slope.
    pub(super) slope_j: f64,
    /// Trees.
    pub(super) trees_j: f64,
}

impl MeshEnergy {
    /// Energy of trees, or of the slope.
    fn on(&self, is_tree: bool) -> f64 {
        if is_tree { self.trees_j } else { self.slope_j }
    }

    /// Difference from another.
    #[must_use]
    pub(super) fn minus(&self, other: &Self) -> Self {
        Self { slope_j: self.slope_j - other.slope_j, trees_j: self.trees_j - other.trees_j }
    }
}

/// The part of the mesh to which a patch belongs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PatchOwner {
    pub(super) sheet: u16,
    pub(super) is_tree: bool,
    /// Number of the stem, where trees may break: two that stand side by side are hit one after the
    /// other.
    pub(super) stem: Option<u32>,
}

/// An active impact, or one that has just ended. Ended impacts stay for `SAME_IMPACT_S`, so that a
/// patch that closes again finds its row.
#[derive(Debug, Clone, Copy)]
struct RecentImpact {
    /// Number among the impacts of the rock, from 1.
    number: u32,
    owner: PatchOwner,
    normal: Vec3,
    /// Weight of its share of the energy lost while it is active (m²/s²).
    weight: f64,
    /// Latest time of its end (s), and time at which its patch opened (s).
    ///
    /// A patch that holds the rock for good (rolling, rest) would never open: its impact ends by
    /// time.
    latest_end_s: f64,
    ended_s: Option<f64>,
}

/// The impacts of one rock.
#[derive(Debug, Default)]
pub(super) struct Impacts {
    /// Rows, if they are kept.
    pub(super) rows: Vec<Impact>,
    /// Number of impacts so far.
    pub(super) count: u32,
    keeps_rows: bool,
    recent: RecentImpacts,
}

/// Active impacts and those just ended, without allocation.
#[derive(Debug, Clone, Copy, Default)]
struct RecentImpacts {
    slots: [Option<RecentImpact>; MAX_CONTACTS],
    /// Energy that had gone into contacts with the mesh when the first impact of the group began,
    /// and the part of it that went into soil (J): sums of the energy balance. The loss of the
    /// group is the difference at its end.
    start_j: (MeshEnergy, f64),
}

impl RecentImpacts {
    /// A slot for one more impact: a free one, else that of the impact that began first, among
    /// ended impacts if there are any. There are as many slots as a rock has contacts; more at once
    /// cannot be.
    fn free_slot(&mut self) -> &mut Option<RecentImpact> {
        let rank = |slot: &Option<RecentImpact>| {
            slot.as_ref().map(|impact| (impact.ended_s.is_none(), impact.number))
        };
        let oldest = (0..MAX_CONTACTS).min_by_key(|&k| rank(&self.slots[k])).unwrap_or(0);
        &mut self.slots[oldest]
    }
}

/// State of the impacts at an instant, to restore. Rows only grow, so their number suffices.
#[derive(Debug)]
pub(super) struct ImpactsMark {
    rows: usize,
    count: u32,
    recent: RecentImpacts,
}

impl Impacts {
    pub(super) fn new(keeps_rows: bool) -> Self {
        Self { keeps_rows, ..Self::default() }
    }

    pub(super) fn mark(&self) -> ImpactsMark {
        ImpactsMark { rows: self.rows.len(), count: self.count, recent: self.recent }
    }

    pub(super) fn restore(&mut self, mark: &ImpactsMark) {
        self.rows.truncate(mark.rows);
        (self.count, self.recent) = (mark.count, mark.recent);
    }

    /// Whether any impact is active.
    #[inline]
    pub(super) fn is_any_active(&self) -> bool {
        self.active().next().is_some()
    }

    fn active(&self) -> impl Iterator<Item = &RecentImpact> {
        self.recent.slots.iter().flatten().filter(|impact| impact.ended_s.is_none())
    }

    /// Begins an impact at `now_s` (s) and `speed_m_s`, to end at `latest_end_s` (s) at the latest,
    /// or continues that of the same patch. `lost_j` is the energy that has gone into contacts with
    /// the mesh so far, and the part of it that went into soil. Returns its number, and whether it
    /// is new.
    pub(super) fn begin(
        &mut self,
        (struck, owner): (&ImpactPoint, PatchOwner),
        (now_s, latest_end_s): (f64, f64),
        speed_m_s: f64,
        lost_j: (MeshEnergy, f64),
    ) -> (u32, bool) {
        if !self.is_any_active() {
            self.recent.start_j = lost_j;
        }
        // a speed of 0 must not leave a group without any weight
        let weight = struck.approach_m_s.powi(2).max(f64::MIN_POSITIVE);
        // same mesh and nearly the same normal: a rock that rolls over a seam hits no second patch
        let is_same = |impact: &&mut RecentImpact| {
            impact.ended_s.is_some_and(|ended_s| now_s - ended_s <= SAME_IMPACT_S)
                && impact.owner == owner
                && impact.normal.dot(&struck.normal) > SAME_CONTACT_COSINE
        };
        if let Some(impact) = self.recent.slots.iter_mut().flatten().find(is_same) {
            let number = impact.number;
            *impact = RecentImpact {
                normal: struck.normal,
                weight,
                latest_end_s,
                ended_s: None,
                ..*impact
            };
            return (number, false);
        }
        self.count += 1;
        let number = self.count;
        let normal = struck.normal;
        let impact = RecentImpact { number, owner, normal, weight, latest_end_s, ended_s: None };
        *self.recent.free_slot() = Some(impact);
        if self.keeps_rows {
            self.rows.push(Impact {
                time_s: now_s,
                point_m: struck.point_m,
                feature: struck.feature,
                sheet: owner.sheet,
                speed_in_m_s: speed_m_s,
                speed_out_m_s: speed_m_s,
                energy_lost_j: 0.0,
                soil_j: 0.0,
            });
        }
        (number, true)
    }

    /// Ends, at `now_s` (s) and `speed_m_s`, the impacts whose time is over and those whose patch
    /// no longer `holds` the rock.
    pub(super) fn end(&mut self, now_s: f64, speed_m_s: f64, holds: impl Fn(u32) -> bool) {
        for impact in self.recent.slots.iter_mut().flatten() {
            if impact.ended_s.is_none() && (now_s >= impact.latest_end_s || !holds(impact.number)) {
                impact.ended_s = Some(now_s);
                if self.keeps_rows {
                    // numbers count from 1, rows from 0
                    self.rows[impact.number as usize - 1].speed_out_m_s = speed_m_s;
                }
            }
        }
    }

    /// Books the energy of a group once none of its impacts is active any more. `lost_j` has gone
    /// into contacts with the mesh so far, without what springs still hold; `soil_j` of it went
    /// into soil.
    pub(super) fn book(&mut self, (lost_j, soil_j): (MeshEnergy, f64)) {
        if !self.keeps_rows || self.is_any_active() {
            return;
        }
        let taken_j = lost_j.minus(&self.recent.start_j.0);
        for is_tree in [false, true] {
            // never negative: rounding of a step may be a gain
            let taken_j = taken_j.on(is_tree).max(0.0);
            // there is no soil on trees
            let most_soil_j = if is_tree { 0.0 } else { taken_j };
            self.share(is_tree, taken_j, (soil_j - self.recent.start_j.1).clamp(0.0, most_soil_j));
        }
    }

    /// Distributes what trees, or the slope, took among the impacts on them. What a patch without
    /// an impact took is in no row.
    fn share(&mut self, is_tree: bool, taken_j: f64, soil_j: f64) {
        let is_on_owner = |impact: &&mut RecentImpact| impact.owner.is_tree == is_tree;
        let weights = self.recent.slots.iter_mut().flatten().filter(is_on_owner);
        let weight_sum: f64 = weights.map(|impact| impact.weight).sum();
        if weight_sum <= 0.0 {
            return;
        }
        for impact in self.recent.slots.iter_mut().flatten().filter(is_on_owner) {
            let row = &mut self.rows[impact.number as usize - 1];
            row.energy_lost_j += taken_j * impact.weight / weight_sum;
            row.soil_j += soil_j * impact.weight / weight_sum;
            impact.weight = 0.0;
        }
    }

    /// Forgets ended impacts: a contact from now on is another impact, wherever it is.
    pub(super) fn forget_ended(&mut self) {
        for slot in &mut self.recent.slots {
            slot.take_if(|impact| impact.ended_s.is_some());
        }
    }
}
