//! The fall itself: leap, touch, step, stop.
//!
//! A journey alternates between two exact pictures. In flight the centre moves on a parabola, and the next touch is
//! the smallest root at which it comes within a radius of the mesh: no steps, no air drag. In contact a scheme
//! integrates translation, spin and springs until no contact is left. An episode of contact closes with an energy
//! balance: motion before and after, losses booked by cause, and the remainder, which is the error of the numerics.

use super::Stop;
use super::form::RockInstant;
use super::recorder::Recorder;
use super::rest::RestCriterion;
use super::settings::RunSettings;
use crate::rock::Vec3;
use crate::solver::loss::Loss;
use crate::solver::step_control::{Advance, StepError};

/// A rock on its way, sphere or block, as the driver asks for it.
pub(super) trait Falling<'a> {
    /// What the scheme knows from step to step of one episode of contact.
    type Stepping;

    fn settings(&self) -> &'a RunSettings<'a>;

    fn recorder(&mut self) -> &mut Recorder<'a>;

    /// Its centre (m), and the radius of the ball around it, whose rim must be slow too where it rests (m).
    fn ball(&self) -> (Vec3, f64);

    /// Mechanical energy (J), weight included: `m v²/2 + ω·L/2 − m g·c`; springs are not in it.
    fn total_j(&self) -> f64;

    /// Leaps to the next touch; `None` = it touches.
    fn fly(&mut self) -> Option<Stop>;

    /// Begins an episode of contact; with what springs hold already (J).
    fn begin(&mut self) -> (Self::Stepping, Loss);

    /// What it strikes before a step; whether that has thrown it off.
    fn meet(&mut self) -> bool;

    /// The longest step (s) before roughness, soil, slip or stems change the law.
    fn longest_s(&mut self) -> f64;

    /// One step of at most `most_s` (s), and what it does to soil and stems; whether a contact slides.
    ///
    /// # Errors
    /// [`StepError`] if no step, however short, settles.
    fn step(
        &mut self,
        stepping: &mut Self::Stepping,
        most_s: f64,
    ) -> Result<(Advance, bool), StepError>;

    /// Where and how it is at a time (s).
    fn instant(&self, time_s: f64) -> RockInstant;

    /// Notes a step to `to` and the impacts that end with it; whether nothing holds the rock any more.
    fn note(&mut self, to: RockInstant, slides: bool) -> bool;

    /// What springs hold at the end of an episode (J).
    fn stored(&mut self) -> Loss;

    /// Ends an episode of contact.
    fn leave(&mut self);
}

/// Follows a rock to its stop. One that is `pressed` must not fly out of its grip: a leap sees no touch where none begins.
pub(super) fn follow<'a>(fall: &mut impl Falling<'a>, pressed: bool) -> Stop {
    let mut stop = if pressed { touch(fall) } else { None };
    loop {
        stop = stop.or_else(|| fall.fly()).or_else(|| touch(fall));
        if let Some(stop) = stop {
            return stop;
        }
    }
}

/// Goes on in contact until the rock is free again or stops, and closes the balance of the episode.
///
/// Contact begins with a fresh look: memories of the episode before are gone, as a flight of
/// any length relaxes the springs.
fn touch<'a>(fall: &mut impl Falling<'a>) -> Option<Stop> {
    // a rock released pressed in, or one that never left, begins with energy in its springs: it counts as brought along
    let (mut stepping, held) = fall.begin();
    let (before_j, lost_before_j) = (fall.total_j(), fall.recorder().lost_j());
    let stop = steps(fall, &mut stepping);
    // ΔE of motion and weight; with losses ≥ 0 and springs at rest at both ends it is −(losses)
    // up to the numerics' own error, the remainder
    let rise_j = fall.total_j() - before_j;
    let recorder = fall.recorder();
    recorder.ledger.remainder_j -= rise_j + (recorder.lost_j() - lost_before_j);
    let stored = fall.stored();
    fall.recorder().end_episode(rise_j, &stored, &held);
    fall.leave();
    stop
}

/// Steps through one episode of contact, until the rock flies (`None`) or ends.
///
/// Each step: what the ground changes first, the step of the scheme, what it has struck, then the record. The
/// order matters: impacts are noted with the speed before their losses are paid.
fn steps<'a, F: Falling<'a>>(fall: &mut F, stepping: &mut F::Stepping) -> Option<Stop> {
    let settings = fall.settings();
    let (centre, radius_m) = fall.ball();
    let mut calm = RestCriterion::from(centre);
    loop {
        if fall.meet() {
            return None;
        }
        let from = fall.recorder().now;
        let left = settings.longest_s - from.time_s;
        let calm_s = calm.longest_s(&from, radius_m, &settings.rest);
        // the shortest of the time left, of what tells rest, and of what changes the law
        let most_s = left.min(calm_s).min(fall.longest_s());
        let (done, slides) = match fall.step(stepping, most_s) {
            Ok(done) => done,
            Err(stuck) => return Some(Stop::Failed(stuck.to_string())),
        };
        let recorder = fall.recorder();
        recorder.effort.steps += done.steps;
        recorder.effort.rejected += done.rejected;
        recorder.effort.unsettled += u64::from(done.unsettled);
        recorder.pay(&done.loss);
        let to = fall.instant(from.time_s + done.dt);
        let is_free = fall.note(to, slides);
        let ends = settings.end_of_step(from.time_s, done.dt, &fall.recorder().effort);
        if is_free {
            return ends;
        }
        // rest: slow for long enough, and neither faster nor farther at the end than at the start
        calm.note(done.dt, [&from, &to.motion], radius_m, &settings.rest);
        if calm.rests() {
            return Some(Stop::AtRest);
        }
        if ends.is_some() {
            return ends;
        }
    }
}
