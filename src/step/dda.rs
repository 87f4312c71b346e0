//! Scheme `dda`: the paper's displacement-based step at a fixed time step.
//!
//! The unknown of a step is the displacement `D` under constant acceleration (Newmark β = 1/2, γ = 1, the
//! right-Riemann rule): `(2M/Δt² + K) D = m g + (2M/Δt) V₀ + F`, `V₁ = 2D/Δt − V₀`. Contacts are those of the step's
//! start, with their normals; whether they are open, sliding or sticking is found by open–close iteration.
//!
//! Solved is for `E = D − D₀`, what contacts add to the free displacement `D₀ = V₀ Δt + g Δt²/2`:
//! `(2M/Δt² + K) E = F − K D₀`. It is the same equation; a motion no contact acts on keeps every bit.
//!
//! Work equals the change of kinetic energy exactly, `(V₁² − V₀²) M/2 = (F + m g)·D`, and all forces but gravity are
//! those of springs at the step's end or against the step's displacement: springs lose `k (Δx)²/2` a step and nothing
//! gains, however long the step. Dashpots act on the mean velocity `D/Δt` for that reason: on `V₁` they may add energy
//! where a step turns the motion round.

mod joint;

pub use joint::Joint;

use super::Settings;
use super::adaptive::{Advance, Stuck};
use super::grip::{Grip, Loss, World};
use crate::contact::submatrix::{Mat6, Vec6, inertia};
use crate::rock::Vec3;
use joint::{Change, Step};
use nalgebra::Cholesky;
use std::f64::consts::PI;

/// Solves of the open–close iteration (Shi's practice; the paper states no limit).
const ROUNDS: u32 = 6;
/// Longest way in one step (–, relative to R) where more than one plane is near: features are seen a tenth of the
/// radius ahead.
const TRAVEL: f64 = 0.09;
/// Deepest penetration that still is one (–, relative to R). Where the centre passes the surface `V` turns round and
/// the contact would push the rock through.
const DEEPEST: f64 = 0.5;
/// Contact oscillation per step (rad) from which the scheme no longer oscillates: its eigenvalues turn real.
pub const LOTTERY_PHASE: f64 = 4.0;

/// Normal restitution (–) that the step leaves of an undamped impact at `ω Δt` = `phase` (rad); `None` from 4 on,
/// where it is anything between 0 and 1.
///
/// The step shrinks the oscillation by `(1+q)^(−1/2)` while its phase turns by `θ = acos((2−q)/(2 √(1+q)))`,
/// `q = phase²/2`; half a period keeps `e = (1+q)^(−π/(2θ))`.
pub fn own_restitution(phase: f64) -> Option<f64> {
    let q = 0.5 * phase * phase;
    let angle = ((2.0 - q) / (2.0 * (1.0 + q).sqrt())).acos();
    (phase < LOTTERY_PHASE).then(|| (1.0 + q).powf(-PI / (2.0 * angle)))
}

/// The fixed step of one contact episode.
#[derive(Debug)]
pub struct Fixed {
    step_s: f64,
    shear_memory: bool,
    /// Energy in the springs at the present state (J).
    stored: Loss,
}

impl Fixed {
    /// Begins an episode.
    pub fn new(settings: &Settings, world: &World, grip: &mut Grip) -> Self {
        let c = grip.c;
        grip.look_ahead(world, &c);
        let stored = grip.stored_j(world);
        Self { step_s: settings.step_s, shear_memory: settings.shear_memory, stored }
    }

    /// One step of at most `h_max` (s). Between steps the grip's touches are those of its present place.
    ///
    /// # Errors
    /// [`Stuck`] if the rock sank in or its motion is no longer finite.
    pub fn advance(
        &mut self,
        world: &World,
        grip: &mut Grip,
        h_max: f64,
    ) -> Result<Advance, Stuck> {
        let dt = self.step_s.min(h_max).min(grip.longest_step(world, TRAVEL));
        let step = Step {
            dt,
            free: free_motion(world, grip, dt),
            radius: world.body.radius,
            shear_memory: self.shear_memory,
        };
        meet(world, &step, grip);
        let (added, settled) = settle(world, &step, grip).ok_or(Stuck::NotFinite)?;
        let d = step.free + added;
        let mut done = Advance { dt, unsettled: !settled, ..Advance::default() };
        for joint in &grip.joints[..grip.joint_count] {
            if joint.depth(&d) > DEEPEST * step.radius {
                return Err(Stuck::SankIn);
            }
            done.loss.add(&joint.loss(&d).on(world, joint.triangle), 1.0);
        }
        carry_on(world, grip, &d, &(added * (2.0 / dt)), dt);
        let stored = grip.stored_j(world);
        done.loss.add(&stored, 1.0);
        done.loss.add(&self.stored, -1.0);
        self.stored = stored;
        Ok(done)
    }
}

fn six(a: &Vec3, b: &Vec3) -> Vec6 {
    Vec6::new(a.x, a.y, a.z, b.x, b.y, b.z)
}

/// Displacement and rotation over `dt` without contacts.
fn free_motion(world: &World, grip: &Grip, dt: f64) -> Vec6 {
    six(&(grip.v * dt + world.body.gravity * (0.5 * dt * dt)), &(grip.w * dt))
}

/// Makes the touches of the step's start into contacts.
fn meet(world: &World, step: &Step, grip: &mut Grip) {
    grip.joint_count = grip.touches.len();
    let (v, mut taken) = (grip.v, 0);
    for k in 0..grip.joint_count {
        let hold = grip.hold_of(world, k, taken, &v);
        taken |= 1 << hold;
        let touch = &grip.touches[k];
        let law = world.law(touch.triangle);
        grip.joints[k] = Joint::new(step, law, touch, (hold, &grip.holds[hold]));
    }
}

/// Open–close iteration: what contacts add to the free displacement, and whether their states settled.
///
/// A step that does not settle ends with the contested contacts closed and sticking. `None` if it has no solution.
fn settle(world: &World, step: &Step, grip: &mut Grip) -> Option<(Vec6, bool)> {
    let joints = &mut grip.joints[..grip.joint_count];
    let mut system = System::default();
    for _ in 0..ROUNDS {
        grip.sweeps += 1;
        let added = system.solve(world, step, joints)?;
        let d = step.free + added;
        match joints.iter_mut().map(|joint| joint.judge(&d)).max() {
            None | Some(Change::None) => return Some((added, true)),
            Some(Change::Load) => {}
            Some(Change::Mode) => system = System::default(),
        }
    }
    grip.sweeps += 1;
    joints.iter_mut().for_each(Joint::give_in);
    let added = System::default().solve(world, step, joints)?;
    joints.iter_mut().for_each(|joint| joint.accept(&(step.free + added)));
    Some((added, false))
}

/// Stiffness of the contacts and the factor of the whole matrix, as long as no contact changes its state.
#[derive(Default)]
struct System(Option<(Mat6, Cholesky<f64, nalgebra::U6>)>);

impl System {
    fn solve(&mut self, world: &World, step: &Step, joints: &[Joint]) -> Option<Vec6> {
        let (contacts, factor) = match &self.0 {
            Some(known) => known,
            None => {
                let mut contacts = Mat6::zeros();
                joints.iter().for_each(|joint| joint.add_stiffness(&mut contacts));
                let body = &world.body;
                let whole = contacts + inertia(body.mass, body.inertia, step.dt);
                self.0.insert((contacts, Cholesky::new(whole)?))
            }
        };
        let mut load = -(contacts * step.free);
        joints.iter().for_each(|joint| joint.add_load(&mut load));
        factor.solve_mut(&mut load);
        load.iter().all(|x| x.is_finite()).then_some(load)
    }
}

/// Moves the rock by `d`, its velocity by what contacts added, and looks where it has got to.
fn carry_on(world: &World, grip: &mut Grip, d: &Vec6, kick: &Vec6, dt: f64) {
    for hold in grip.holds.iter_mut() {
        hold.closed = false;
    }
    for joint in &grip.joints[..grip.joint_count] {
        joint.remember(d, &mut grip.holds[joint.hold]);
    }
    grip.holds.retain(|hold| hold.closed);
    grip.c += d.fixed_rows::<3>(0);
    grip.v += world.body.gravity * dt + kick.fixed_rows::<3>(0);
    grip.w += kick.fixed_rows::<3>(3);
    let (c, v, r) = (grip.c, grip.v, world.body.radius);
    grip.look_ahead(world, &c);
    if grip.is_free() {
        // A rock that has left one contact but is inside another must not fly.
        let inside = (0..grip.touches.len()).find(|&k| grip.touches[k].distance_m < r);
        if let Some(k) = inside {
            let hold = grip.hold_of(world, k, 0, &v);
            grip.holds[hold].closed = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed form evaluated by hand; at z = 2 it is `3^(−π/(2 acos 0)) = 1/3`.
    #[test]
    fn the_scheme_keeps_what_the_table_says() {
        let table = [
            (0.01, 0.992_177),
            (0.1, 0.924_563),
            (0.5, 0.683_764),
            (1.0, 0.497_301),
            (2.0, 1.0 / 3.0),
        ];
        for (phase, restitution) in table {
            // six printed digits
            assert!((own_restitution(phase).unwrap() - restitution).abs() < 6e-7, "{phase}");
        }
        assert_eq!(own_restitution(4.0), None);
    }
}
