//! A sphere on its way: what it meets, what it is, what is noted down of it.

use super::recorder::Recorder;
use super::rock_in_contact::RockInContact;
use super::settings::RunSettings;
use crate::ground::Law;
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::contact_state::ContactState;
use crate::solver::scar::Scars;
use crate::solver::slip::Slip;

/// One sphere.
/// Everything that a journey needs and nothing that outlives it.
pub(super) struct Fall<'a> {
    pub(super) settings: &'a RunSettings<'a>,
    pub(super) body: Body,
    /// Those in force: soil and the speed of impacts change them on the way.
    pub(super) laws: &'a mut [Law],
    pub(super) soil: Soil<'a>,
    pub(super) state: &'a mut ContactState,
    pub(super) recorder: Recorder<'a>,
}

impl<'a> Fall<'a> {
    /// Whether contacts have no springs: those of the rigid limit hold nothing, whatever the depth that rounding leaves.
    pub(super) fn is_rigid(&self) -> bool {
        !self.settings.step.scheme.has_springs()
    }

    /// The rock and its notes.
    pub(super) fn in_contact(&mut self) -> RockInContact<'_, 'a> {
        let has_springs = !self.is_rigid();
        let Self { settings, body, laws, state, recorder, .. } = self;
        RockInContact { world: settings.around(*body, laws), state, recorder, has_springs }
    }
}

/// What a sphere does to soil.
/// All of it is changed between steps, so a step itself sees constant laws.
pub(super) struct Soil<'a> {
    pub(super) scars: &'a mut Scars,
    pub(super) slip: &'a mut Slip,
    /// Where it slips fastest since the step in hand began.
    pub(super) slips: Option<Slips>,
    /// How long the step before was (s), 0 after a flight.
    pub(super) last_step_s: f64,
}

/// A contact that slips.
///
/// Speed of the contact point along the surface, normal of the contact, and the ground on which it
/// slips.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slips {
    pub(super) speed_m_s: f64,
    pub(super) n: Vec3,
    pub(super) ground: u16,
}

impl<'a> Soil<'a> {
    /// Of a rock that has not moved yet.
    pub(super) fn new(scars: &'a mut Scars, slip: &'a mut Slip) -> Self {
        Self { scars, slip, slips: None, last_step_s: 0.0 }
    }

    /// Flies for so long (s).
    pub(super) fn fly(&mut self, flight_s: f64) {
        self.scars.fly(flight_s);
        self.slip.fly(flight_s);
        self.last_step_s = 0.0;
    }
}
