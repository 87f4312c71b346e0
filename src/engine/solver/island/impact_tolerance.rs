//! Error tolerance of an island: relative to the speed of the impacts under way, as for a rock
//! alone.
//!
//! An absolute local error that is small for a block falling from a wall is large for a pebble.
//! While a rock of the island is in an impact, with the mesh or another rock, its own error is
//! therefore limited to a share of the speed of its fastest impact. The scale of sustained contact
//! is `√(g R)`, the speed of a rock that tips over an edge. The stages of an impact are those of
//! order four: at such errors they are cheaper.
//!
//! Bonded rocks vibrate after a blow. They are stepped with the stages of order four as well: those
//! of order two would damp an undamped vibration.
//!
//! An impact of two bodies without other contacts is as accurate as that of a rock alone. Where a
//! blow is transmitted through several contacts at once, as in a heap, its outcome depends on gaps
//! far below any known precision: a larger share is enough there.

use super::assembly::Island;
use super::body::IslandBody;
use super::pair_contact::PairContact;
use crate::contact::history::ContactHistory;
use crate::rock::Vec3;
use crate::solver::Settings;
use crate::solver::impact::LOCAL_ERROR;
use crate::solver::step_control::{Control, sustained_tolerance_m_s};
use crate::solver::tableau::{ESDIRK4, TR_BDF2};

/// Local error allowed in an impact (–, relative to its speed): per 1 m/s of the tolerance of
/// sustained contact, and at most, as for a rock alone at the usual tolerance.
const IMPACT: (f64, f64) = (1.0, 2e-4);
/// Factor on it where one of the two bodies also touches others (–): at the usual tolerance 1 % of
/// the speed of the blow.
const IN_HEAP: f64 = 150.0;
/// Factor on it where the blow is transmitted through one further contact only (–): its outcome
/// depends on that one gap.
const THROUGH_ONE: f64 = 30.0;

/// Cosine between two contacts of a rock from which a blow on one is transmitted through the other
/// (–).
const TRANSMITS: f64 = 0.1;

/// Local error allowed for two bonded rocks (–), relative to the speed at which their springs would
/// reach the strength of the bond, and to that of their vibration: a blow ends in a vibration, and
/// the failure of the bond is decided swings later, by the accumulated error.
const BOND_ERROR: f64 = 1e-3;
/// Lower bound of it for bonds that any load breaks (–, relative to the local error in sustained
/// contact) …
const LEAST_BOND_ERROR: f64 = 1e-3;
/// … and for vibrations that are negligibly slow.
const LEAST_VIBRATION_ERROR: f64 = 0.02;

impl Island<'_> {
    /// The control of the next step: the errors allowed for the rocks, and the method.
    pub(super) fn control(&mut self, settings: &Settings) -> Control {
        let usual = settings.scheme.tableau().unwrap_or(&TR_BDF2);
        let relative = LOCAL_ERROR * (IMPACT.0 * settings.tolerance_m_s).min(IMPACT.1);
        self.note_impacts(false);
        let mut has_impact = false;
        for member in self.members.iter_mut().map(|slot| &mut **slot) {
            member.sustained_tolerance_m_s = sustained_tolerance_m_s(settings, &member.body);
            has_impact |= member.impact_m_s > 0.0 && !member.is_in_heap();
        }
        has_impact |= self.limit_bond_errors(settings);
        let allowed = self.members.iter().map(|member| member.allowed_m_s(relative));
        self.tolerance = allowed.fold(f64::INFINITY, f64::min);
        Control {
            tableau: if has_impact { &ESDIRK4 } else { usual },
            tolerance: self.tolerance,
            impact: relative,
            impact_kernels: false,
        }
    }

    /// Limits the error of bonded rocks by strength and vibration of their bonds; whether that is
    /// less than sustained contact allows.
    fn limit_bond_errors(&mut self, settings: &Settings) -> bool {
        let mut is_limited = false;
        for pair_history in &self.pair_histories {
            let Some(breaking_speed_m_s) = pair_history.breaking_speed_m_s() else { continue };
            let ends = [pair_history.a, pair_history.b].map(|end| end as usize);
            let [a, b] = ends.map(|end| &self.members[end]);
            let vibration_speed_m_s = pair_history.vibration_speed_m_s(&(a.state.v - b.state.v));
            for end in ends {
                let member = &mut *self.members[end];
                let usual_m_s = sustained_tolerance_m_s(settings, &member.body);
                let of_strength_m_s =
                    (BOND_ERROR * breaking_speed_m_s).max(LEAST_BOND_ERROR * usual_m_s);
                let of_vibration_m_s =
                    (BOND_ERROR * vibration_speed_m_s).max(LEAST_VIBRATION_ERROR * usual_m_s);
                let bonded_m_s = of_strength_m_s.min(of_vibration_m_s);
                is_limited |= bonded_m_s < usual_m_s;
                member.sustained_tolerance_m_s = member.sustained_tolerance_m_s.min(bonded_m_s);
            }
        }
        is_limited
    }

    /// Notes the impact speed of each rock (m/s) and the numbers of bodies in contact, with new
    /// contacts of the present try if it has been `tried`.
    pub(super) fn note_impacts(&mut self, tried: bool) {
        for member in self.members.iter_mut().map(|slot| &mut **slot) {
            let state = &member.state;
            let new_m_s = if tried { state.new_contact_approach_m_s() } else { 0.0 };
            let running_m_s = if state.is_rebounding() { state.impact.speed_m_s } else { 0.0 };
            member.impact_m_s = running_m_s.max(new_m_s);
            (member.touched_count, member.max_touched_count) = (0, 0);
        }
        let Self { members, pair_histories, pairs, .. } = self;
        let held = pair_histories.iter().filter(|pair_history| pair_history.is_held());
        let held = held.map(|pair_history| {
            let ends = [pair_history.a as usize, pair_history.b as usize];
            (ends, pair_history.n, pair_history.impact.speed_m_s)
        });
        let is_new = |pair: &&PairContact| {
            pair.normal_force > 0.0 && !pair_histories[pair.pair_history].is_held()
        };
        let met = pairs.iter().filter(|_| tried).filter(is_new);
        let touching_pairs = held.chain(met.map(|pair| (pair.ends, pair.n, pair.impact.speed_m_s)));
        for (ends, _, speed_m_s) in touching_pairs.clone() {
            for end in ends {
                members[end].impact_m_s = members[end].impact_m_s.max(speed_m_s);
                members[end].touched_count += 1;
            }
        }
        for (ends, n, _) in touching_pairs {
            let [first, second] = ends.map(|end| &members[end]);
            let through = [first.touching_through(&n), second.touching_through(&-n)];
            for end in ends {
                members[end].max_touched_count =
                    members[end].max_touched_count.max(through[0].max(through[1]));
            }
        }
    }
}

impl IslandBody {
    /// Number of bodies in contact with it. The mesh counts if the contact along `n`, which points
    /// at its centre, presses it against that: a blow along the ground is not transmitted through
    /// the ground.
    fn touching_through(&self, n: &Vec3) -> u32 {
        let presses = |history: &ContactHistory| history.n.dot(n) < -TRANSMITS;
        self.touched_count + u32::from(self.state.histories.iter().any(presses))
    }

    /// Whether it, or a rock in contact with it, has more than one contact.
    fn is_in_heap(&self) -> bool {
        self.max_touched_count > 1
    }

    /// Local error allowed for it in an impact (–, relative to its speed), where `relative` is that
    /// of two bodies alone.
    pub(super) fn allowed_share(&self, relative: f64) -> f64 {
        let times = match self.max_touched_count {
            0..=1 => 1.0,
            2 => THROUGH_ONE,
            _ => IN_HEAP,
        };
        times * relative
    }

    /// Local error allowed for it (m/s), `relative` to the speed of an impact (–).
    pub(super) fn allowed_m_s(&self, relative: f64) -> f64 {
        if self.impact_m_s > 0.0 {
            self.sustained_tolerance_m_s.min(self.allowed_share(relative) * self.impact_m_s)
        } else {
            self.sustained_tolerance_m_s
        }
    }
}
