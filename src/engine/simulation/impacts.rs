//! The impacts of one rock: one row for every patch that it strikes.
//!
//! A rock may strike several patches at once, or one while it is still pressed into another. Each has its own approach, its own
//! end and its own speed after it. What trees take while several are under way is shared by those on trees, what the slope takes by
//! those on the slope, each by the squares of their approach speeds, for the energy that each would bring to rest. A patch that opens
//! for an instant and closes again is still the same impact.
//!
//! Why a share by squares: two contacts struck at once are followed as one event, and what each
//! took by itself is not known. The energy `m (n·v)²/2` that an approach along its normal brings
//! is, and it is what a dashpot takes from.

use super::Impact;
use crate::contact::MOST;
use crate::contact::history::SAME_GRIP;
use crate::rock::Vec3;
use crate::solver::impact_point::ImpactPoint;

/// A patch struck again so soon after it has let go (s) is the same impact: its springs opened for an instant, or the rock went
/// on over the side of a triangle.
///
/// Contact times are `π/ω`: 4 ms for a block of 1400 kg on 1e9 N/m, so a millisecond is short
/// against an impact and long against a step.
const SAME_IMPACT_S: f64 = 1e-3;

/// Energy by what of the mesh has it (J).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct MeshEnergy {
    /// The slope.
    pub(super) slope_j: f64,
    /// Trees.
    pub(super) trees_j: f64,
}

impl MeshEnergy {
    /// That of trees, or that of the slope.
    fn of(&self, is_tree: bool) -> f64 {
        if is_tree { self.trees_j } else { self.slope_j }
    }

    /// What is left without another.
    #[must_use]
    pub(super) fn less(&self, other: &Self) -> Self {
        Self { slope_j: self.slope_j - other.slope_j, trees_j: self.trees_j - other.trees_j }
    }
}

/// What of the mesh a patch is on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PatchOwner {
    pub(super) sheet: u16,
    pub(super) is_tree: bool,
    /// Which stem, where trees may break: two that stand side by side are struck one after the other.
    pub(super) stem: Option<u32>,
}

/// An impact under way, or one that is just over.
/// Those just over stay for `SAME_IMPACT_S`, so that a patch that closes again finds its row.
#[derive(Debug, Clone, Copy)]
struct InHand {
    /// Which of the rock's impacts it is, from 1.
    number: u32,
    owner: PatchOwner,
    normal: Vec3,
    /// Its share of what is lost while it lasts (m²/s²).
    weight: f64,
    /// When it is over at the latest (s), and when its patch let go.
    ///
    /// A patch that holds the rock for good (rolling, rest) would never let go: its impact ends by
    /// time.
    until_s: f64,
    over_s: Option<f64>,
}

/// The impacts of one rock.
#[derive(Debug, Default)]
pub(super) struct Impacts {
    /// The rows, if they are kept.
    pub(super) rows: Vec<Impact>,
    /// How many there were.
    pub(super) count: u32,
    keeps_rows: bool,
    hand: Hand,
}

/// Those under way, without allocation.
#[derive(Debug, Clone, Copy, Default)]
struct Hand {
    list: [Option<InHand>; MOST],
    /// What had gone into contacts with the mesh when the first of them began, and what of it into soil (J).
    /// The ledger's sums when the group began: the group's loss is the difference at its end.
    began_j: (MeshEnergy, f64),
}

impl Hand {
    /// A place for one more: a free one, else that of the one which began first, of those that are over if there are any.
    /// Eight places, as a rock keeps eight contacts; more at once cannot be.
    fn place(&mut self) -> &mut Option<InHand> {
        let age = |place: &Option<InHand>| {
            place.as_ref().map(|impact| (impact.over_s.is_none(), impact.number))
        };
        let first = (0..MOST).min_by_key(|&k| age(&self.list[k])).unwrap_or(0);
        &mut self.list[first]
    }
}

/// The impacts at a moment, to go back to.
/// Rows only grow, so their number will do.
#[derive(Debug)]
pub(super) struct ImpactsMark {
    rows: usize,
    count: u32,
    hand: Hand,
}

impl Impacts {
    pub(super) fn kept_if(keeps_rows: bool) -> Self {
        Self { keeps_rows, ..Self::default() }
    }

    pub(super) fn mark(&self) -> ImpactsMark {
        ImpactsMark { rows: self.rows.len(), count: self.count, hand: self.hand }
    }

    pub(super) fn go_back(&mut self, mark: &ImpactsMark) {
        self.rows.truncate(mark.rows);
        (self.count, self.hand) = (mark.count, mark.hand);
    }

    /// Whether any is under way.
    #[inline]
    pub(super) fn is_any(&self) -> bool {
        self.lasting().next().is_some()
    }

    fn lasting(&self) -> impl Iterator<Item = &InHand> {
        self.hand.list.iter().flatten().filter(|impact| impact.over_s.is_none())
    }

    /// Begins one at `now_s` (s) and `speed_m_s`, to end at `until_s` at the latest, or goes on with that of the same patch;
    /// `lost_j` is what has gone into contacts with the mesh so far, and what of it into soil. Returns its number, and whether it is a new one.
    pub(super) fn begin(
        &mut self,
        (struck, owner): (&ImpactPoint, PatchOwner),
        (now_s, until_s): (f64, f64),
        speed_m_s: f64,
        lost_j: (MeshEnergy, f64),
    ) -> (u32, bool) {
        if !self.is_any() {
            self.hand.began_j = lost_j;
        }
        // a speed of 0 must not leave a group without any share
        let weight = struck.approach_m_s.powi(2).max(f64::MIN_POSITIVE);
        // of the same mesh and with nearly the same normal: a rock that rolls over a seam strikes no
        // second patch
        let is_same = |impact: &&mut InHand| {
            impact.over_s.is_some_and(|over_s| now_s - over_s <= SAME_IMPACT_S)
                && impact.owner == owner
                && impact.normal.dot(&struck.normal) > SAME_GRIP
        };
        if let Some(impact) = self.hand.list.iter_mut().flatten().find(is_same) {
            let number = impact.number;
            *impact = InHand { normal: struck.normal, weight, until_s, over_s: None, ..*impact };
            return (number, false);
        }
        self.count += 1;
        let number = self.count;
        let normal = struck.normal;
        let impact = InHand { number, owner, normal, weight, until_s, over_s: None };
        *self.hand.place() = Some(impact);
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

    /// Ends, at `now_s` (s) and `speed_m_s`, those whose time is over and those whose patch no longer `holds` the rock.
    pub(super) fn end(&mut self, now_s: f64, speed_m_s: f64, holds: impl Fn(u32) -> bool) {
        for impact in self.hand.list.iter_mut().flatten() {
            if impact.over_s.is_none() && (now_s >= impact.until_s || !holds(impact.number)) {
                impact.over_s = Some(now_s);
                if self.keeps_rows {
                    // numbers count from 1, rows from 0
                    self.rows[impact.number as usize - 1].speed_out_m_s = speed_m_s;
                }
            }
        }
    }

    /// Once none is in hand any more, books what they took: `lost_j` has gone into contacts with the mesh so far, springs that
    /// are still pressed not counted, and `soil_j` of it into soil.
    pub(super) fn book(&mut self, (lost_j, soil_j): (MeshEnergy, f64)) {
        if !self.keeps_rows || self.is_any() {
            return;
        }
        let taken_j = lost_j.less(&self.hand.began_j.0);
        for is_tree in [false, true] {
            // never less than nothing: a step may gain what it rounds
            let taken_j = taken_j.of(is_tree).max(0.0);
            // there is no soil on trees
            let most_soil_j = if is_tree { 0.0 } else { taken_j };
            self.share(is_tree, taken_j, (soil_j - self.hand.began_j.1).clamp(0.0, most_soil_j));
        }
    }

    /// Shares what trees, or the slope, took among the impacts on them; what a patch took that was not struck is in no row.
    fn share(&mut self, is_tree: bool, taken_j: f64, soil_j: f64) {
        let own = |impact: &&mut InHand| impact.owner.is_tree == is_tree;
        let weights = self.hand.list.iter_mut().flatten().filter(own);
        let whole: f64 = weights.map(|impact| impact.weight).sum();
        if whole <= 0.0 {
            return;
        }
        for impact in self.hand.list.iter_mut().flatten().filter(own) {
            let row = &mut self.rows[impact.number as usize - 1];
            row.energy_lost_j += taken_j * impact.weight / whole;
            row.soil_j += soil_j * impact.weight / whole;
            impact.weight = 0.0;
        }
    }

    /// What strikes from now on is another impact, wherever it strikes.
    pub(super) fn forget_last(&mut self) {
        for place in &mut self.hand.list {
            place.take_if(|impact| impact.over_s.is_some());
        }
    }
}
