//! `[solver]`.

use super::check::{Allowed, Checked, Complaint, optional};
use crate::solver::Scheme;
use serde::Deserialize;

/// How a rock is computed; optional as a whole. What is absent is filled in by the plan, which prints it.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [solver]")]
pub struct SolverTable {
    /// The scheme; absent = `adaptive`.
    pub scheme: Option<Scheme>,
    /// Local error allowed per step (m/s), positive; `adaptive` only.
    pub tolerance_m_s: Option<f64>,
    /// Fixed step of `dda`, largest step of `rigid` (s), positive.
    pub step_s: Option<f64>,
    /// Whether the shear spring remembers its stretch; `dda` only.
    pub shear_memory: Option<bool>,
    /// Blocks: longest way of a corner in one step over the radius of its rounding (–), above 0 and at most 1.
    pub corner_way: Option<f64>,
    /// Impacts slower than this do not rebound (m/s), 0 or more.
    pub capture_speed_m_s: Option<f64>,
    /// Simulated time after which a rock is `time_up` (s), positive.
    pub longest_s: Option<f64>,
    /// Speed below which a rock may be at rest (m/s), positive.
    pub rest_speed_m_s: Option<f64>,
    /// How long it must stay below that speed (s), positive.
    pub rest_time_s: Option<f64>,
}

/// Shortest step of `dda` (s): a shorter one takes a thousand rocks' work for one.
const SHORTEST_STEP_S: f64 = 1e-9;
/// Shortest step of `rigid` (s): a shorter one no longer reduces its error.
const SHORTEST_RIGID_STEP_S: f64 = 1e-6;

impl SolverTable {
    /// The scheme in force.
    pub fn scheme(&self) -> Scheme {
        self.scheme.unwrap_or_default()
    }

    pub(super) fn check(&self) -> Checked {
        self.check_numbers()?;
        let scheme = self.scheme();
        if scheme.has_fixed_step() && self.step_s.is_none() {
            let remedy = "write step_s = 1e-5 or another time step: scheme \"dda\" must have one";
            return Err(Complaint::missing("step_s", remedy));
        }
        // by scheme: dda, adaptive, reference, rigid
        let used = [
            ("tolerance_m_s", self.tolerance_m_s.is_some(), [false, true, false, false]),
            ("step_s", self.step_s.is_some(), [true, false, false, true]),
            ("shear_memory", self.shear_memory.is_some(), [true, false, false, false]),
        ];
        for (key, given, is_used) in used {
            if given && !scheme.of(is_used) {
                let users = Scheme::ALL.into_iter().filter(|scheme| scheme.of(is_used));
                let names = users.map(Scheme::name).collect::<Vec<_>>();
                return Err(Complaint::about(
                    key,
                    format!(
                        "remove it: scheme \"{}\" has no use for it, only {}",
                        scheme.name(),
                        names.join(" and ")
                    ),
                ));
            }
        }
        Ok(())
    }

    fn check_numbers(&self) -> Checked {
        for (key, value, allowed) in [
            ("tolerance_m_s", self.tolerance_m_s, Allowed::Positive),
            ("step_s", self.step_s, Allowed::Positive),
            ("capture_speed_m_s", self.capture_speed_m_s, Allowed::NotNegative),
            ("longest_s", self.longest_s, Allowed::Positive),
            ("rest_speed_m_s", self.rest_speed_m_s, Allowed::Positive),
            ("rest_time_s", self.rest_time_s, Allowed::Positive),
        ] {
            optional(key, value, allowed, "")?;
        }
        let shortest_s =
            if self.scheme().has_springs() { SHORTEST_STEP_S } else { SHORTEST_RIGID_STEP_S };
        let too_short = |step_s: &f64| *step_s < shortest_s;
        if self.step_s.as_ref().is_some_and(too_short) {
            return Err(Complaint::about("step_s", format!("write {shortest_s:e} or more")));
        }
        // what is beyond means nothing: rounding of the speeds, days of fall
        optional("tolerance_m_s", self.tolerance_m_s, Allowed::Between(1e-9, 10.0), "")?;
        optional("longest_s", self.longest_s, Allowed::Between(1e-3, 1e5), "")?;
        optional("rest_time_s", self.rest_time_s, Allowed::Between(1e-6, 1e5), "")?;
        optional("rest_speed_m_s", self.rest_speed_m_s, Allowed::Between(1e-6, 10.0), "")?;
        optional("corner_way", self.corner_way, Allowed::Between(1e-4, 1.0), "")?;
        Ok(())
    }
}
