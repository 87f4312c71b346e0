//! The fall itself: leap, touch, step, stop.
//!
//! A journey alternates between two exact pictures. In flight the centre moves on a parabola, and the next touch is
//! the smallest root at which it comes within a radius of the mesh: no steps, no air drag. In contact a scheme
//! integrates translation, spin and springs until no contact is left. An episode of contact closes with an energy
//! balance: motion before and after, losses booked by cause, and the remainder, which is the error of the numerics.

use super::Stop;
use super::recorder::Recorder;
use super::rest::RestCriterion;
use super::rock_geometry::RockInstant;
use super::settings::RunSettings;
use crate::rock::Vec3;
use crate::solver::loss::Loss;
use crate::solver::step_control::{Advance, StepError};

/// A rock on its way, sphere or block, as the driver asks for it.
pub(super) trait RockSimulation<'a> {
    /// What the scheme knows from step to step of one episode of contact.
    type StepperState;

    fn settings(&self) -> &'a RunSettings<'a>;

    fn recorder(&mut self) -> &mut Recorder<'a>;

    /// Its centre (m), and the radius of the ball around it, whose rim must be slow too where it rests (m).
    fn bounding_sphere(&self) -> (Vec3, f64);

    /// Mechanical energy (J), weight included: `m v²/2 + ω·L/2 − m g·c`; springs are not in it.
    fn mechanical_energy_j(&self) -> f64;

    /// Leaps to the next touch; `None` = it touches.
    fn fly(&mut self) -> Option<Stop>;

    /// Begins an episode of contact; with what springs hold already (J).
    fn begin_contact(&mut self) -> (Self::StepperState, Loss);

    /// What it strikes before a step; whether that has thrown it off.
    fn resolve_impacts(&mut self) -> bool;

    /// The longest step (s) before roughness, soil, slip or stems change the law.
    fn prepare_step(&mut self) -> f64;

    /// One step of at most `longest_s` (s), and what it does to soil and stems; whether a contact slides.
    ///
    /// # Errors
    /// [`StepError`] if no step, however short, settles.
    fn step(
        &mut self,
        stepping: &mut Self::StepperState,
        longest_s: f64,
    ) -> Result<(Advance, bool), StepError>;

    /// Where and how it is at a time (s).
    fn instant(&self, time_s: f64) -> RockInstant;

    /// Notes a step to `to` and the impacts that end with it; whether nothing holds the rock any more.
    fn record_step(&mut self, to: RockInstant, slides: bool) -> bool;

    /// What springs hold at the end of an episode (J).
    fn spring_energy(&mut self) -> Loss;

    /// Ends an episode of contact.
    fn end_contact(&mut self);
}

/// Follows a rock to its stop. One that is `penetrates` must not fly out of its grip: a leap sees no touch where none begins.
pub(super) fn run_to_stop<'a>(rock: &mut impl RockSimulation<'a>, penetrates: bool) -> Stop {
    let mut stop = if penetrates { contact_episode(rock) } else { None };
    loop {
        stop = stop.or_else(|| rock.fly()).or_else(|| contact_episode(rock));
        if let Some(stop) = stop {
            return stop;
        }
    }
}

/// Goes on in contact until the rock is free again or stops, and closes the balance of the episode.
///
/// Contact begins with a fresh look: memories of the episode before are gone, as a flight of
/// any length relaxes the springs.
fn contact_episode<'a>(rock: &mut impl RockSimulation<'a>) -> Option<Stop> {
    // a rock released pressed in, or one that never left, begins with energy in its springs: it counts as brought along
    let (mut stepping, spring_energy_before) = rock.begin_contact();
    let (before_j, lost_before_j) = (rock.mechanical_energy_j(), rock.recorder().lost_j());
    let stop = contact_steps(rock, &mut stepping);
    // ΔE of motion and weight; with losses ≥ 0 and springs at rest at both ends it is −(losses)
    // up to the numerics' own error, the remainder
    let rise_j = rock.mechanical_energy_j() - before_j;
    let recorder = rock.recorder();
    recorder.ledger.remainder_j -= rise_j + (recorder.lost_j() - lost_before_j);
    let spring_energy = rock.spring_energy();
    rock.recorder().end_episode(rise_j, &spring_energy, &spring_energy_before);
    rock.end_contact();
    stop
}

/// Steps through one episode of contact, until the rock flies (`None`) or ends.
///
/// Each step: what the ground changes first, the step of the scheme, what it has struck, then the record. The
/// order matters: impacts are noted with the speed before their losses are paid.
fn contact_steps<'a, F: RockSimulation<'a>>(
    rock: &mut F,
    stepping: &mut F::StepperState,
) -> Option<Stop> {
    let settings = rock.settings();
    let (centre, radius_m) = rock.bounding_sphere();
    let mut rest_criterion = RestCriterion::new(centre);
    loop {
        if rock.resolve_impacts() {
            return None;
        }
        let from = rock.recorder().now;
        let time_left_s = settings.longest_s - from.time_s;
        let rest_s = rest_criterion.longest_s(&from, radius_m, &settings.rest);
        // the shortest of the time left, of what tells rest, and of what changes the law
        let longest_s = time_left_s.min(rest_s).min(rock.prepare_step());
        let (done, slides) = match rock.step(stepping, longest_s) {
            Ok(done) => done,
            Err(error) => return Some(Stop::Failed(error.to_string())),
        };
        let recorder = rock.recorder();
        recorder.effort.steps += done.steps;
        recorder.effort.rejected += done.rejected;
        recorder.effort.unsettled += u64::from(done.unsettled);
        recorder.book_losses(&done.loss);
        let to = rock.instant(from.time_s + done.dt);
        let is_free = rock.record_step(to, slides);
        let ends = settings.end_of_step(from.time_s, done.dt, &rock.recorder().effort);
        if is_free {
            return ends;
        }
        // rest: slow for long enough, and neither faster nor farther at the end than at the start
        rest_criterion.add_step(done.dt, [&from, &to.motion], radius_m, &settings.rest);
        if rest_criterion.is_at_rest() {
            return Some(Stop::AtRest);
        }
        if ends.is_some() {
            return ends;
        }
    }
}
