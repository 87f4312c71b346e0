//! How exactly an island steps: relative to the speed of the impacts that go on, as for a rock alone.
//!
//! An absolute local error is a small one for a block that falls from a wall and a large one for a pebble. While a rock of the
//! island is struck, by the mesh or by another, its own error is therefore held to a share of the speed of its fastest impact.
//! Lasting contact knows `√(g R)`, the speed of a rock that tips over an edge. The stages of an impact are those of order four:
//! at such errors they are the cheaper ones.

use super::assembly::Island;
use super::body::IslandBody;
use crate::solver::Settings;
use crate::solver::impact::LOCAL;
use crate::solver::step_control::{Control, lasting_m_s};
use crate::solver::tableau::{ESDIRK4, TR_BDF2};

/// Local error allowed in an impact (–, relative to its speed) by 1 m/s of that in lasting contact, and at most: that of a rock
/// alone at the usual tolerance.
const IMPACT: (f64, f64) = (1.0, 2e-4);

impl Island<'_> {
    /// The control of the next step: what the rocks may be wrong by, and by which method.
    pub(super) fn control(&mut self, settings: &Settings) -> Control {
        for member in self.members.iter_mut().map(|slot| &mut **slot) {
            member.lasting_m_s = lasting_m_s(settings, &member.body);
        }
        let usual = settings.scheme.tableau().unwrap_or(&TR_BDF2);
        let relative = LOCAL * (IMPACT.0 * settings.tolerance_m_s).min(IMPACT.1);
        self.note_impacts(false);
        let is_struck = self.members.iter().any(|member| member.struck_m_s > 0.0);
        let allowed = self.members.iter().map(|member| member.allowed_m_s(relative));
        self.tolerance = allowed.fold(f64::INFINITY, f64::min);
        Control {
            tableau: if is_struck { &ESDIRK4 } else { usual },
            tolerance: self.tolerance,
            impact: relative,
            impact_kernels: false,
        }
    }

    /// Notes how fast each rock is struck (m/s), also by what it has only met in the present try.
    pub(super) fn note_impacts(&mut self, tried: bool) {
        for member in self.members.iter_mut().map(|slot| &mut **slot) {
            let state = &member.state;
            let begun_m_s = if tried { state.impact.tried_m_s } else { 0.0 };
            let known_m_s = if state.is_rebounding() { state.impact.speed_m_s } else { 0.0 };
            member.struck_m_s = known_m_s.max(begun_m_s);
        }
        let known = self.pair_histories.iter().filter(|pair_history| pair_history.is_held());
        for pair_history in known {
            for end in [pair_history.a, pair_history.b] {
                self.members[end as usize].is_struck_at(pair_history.impact.speed_m_s);
            }
        }
        if tried {
            for pair in self.pairs.iter().filter(|pair| pair.normal_force > 0.0) {
                for end in pair.ends {
                    self.members[end].is_struck_at(pair.impact.speed_m_s);
                }
            }
        }
    }
}

impl IslandBody {
    fn is_struck_at(&mut self, speed_m_s: f64) {
        self.struck_m_s = self.struck_m_s.max(speed_m_s);
    }

    /// Local error allowed to it (m/s), `relative` to the speed of an impact (–).
    pub(super) fn allowed_m_s(&self, relative: f64) -> f64 {
        if self.struck_m_s > 0.0 {
            self.lasting_m_s.min(relative * self.struck_m_s)
        } else {
            self.lasting_m_s
        }
    }
}
