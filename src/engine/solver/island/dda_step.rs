//! Scheme `dda` for an island: the paper's step at a fixed time step for all of its rocks, see `dda`.

use super::assembly::Island;
use super::body::note_flights;
use super::outcome::IslandAdvance;
use crate::solver::Settings;
use crate::solver::dda::{DdaBody, DdaStep, TRAVEL};
use crate::solver::step_control::StepError;

impl Island<'_> {
    /// One step of the scheme `dda`, at most `h_max` (s) long.
    ///
    /// # Errors
    /// [`StepError`] if a rock sank in or its motion is no longer finite.
    pub fn advance_fixed(
        &mut self,
        settings: &Settings,
        h_max: f64,
    ) -> Result<IslandAdvance, StepError> {
        // the fixed step, limited only by events and by the travel for which features are known
        let dt = settings.step_s.min(h_max).min(self.travel_limit(TRAVEL));
        self.release_struck();
        let Self { terrain, members, pair_histories, dda_pairs: pairs, .. } = self;
        let mut bodies = Vec::with_capacity(members.len());
        for member in members.iter_mut() {
            let (world, state) = member.with_environment(terrain);
            bodies.push(DdaBody::with_contact_points(world, state));
        }
        let bodies = &mut bodies;
        let done =
            DdaStep { bodies, pairs, pair_histories }.advance((dt, settings.shear_memory))?;
        self.sweeps += u64::from(done.solves);
        let (losses, given) = bodies.iter().map(|body| (body.loss, body.given)).unzip();
        note_flights(&mut self.members, &self.pair_histories);
        let (unsettled, broken) = (!done.settled, done.broken);
        Ok(IslandAdvance { dt, losses, given, unsettled, broken, ..IslandAdvance::default() })
    }
}
