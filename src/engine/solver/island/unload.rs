//! Unloading of springs: their energy becomes motion, so that contact may continue in the limit of
//! stiff springs.
//!
//! The spring of an impact under way returns its energy along its normal. If the contact still
//! approaches, the impact begins anew with its initial speed; if it separates, the impact is over.
//! The energy of sustained contact and of shear springs is lost, as it would be where the contact
//! opens: that of weight is small.

use super::body::IslandBody;
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::rock::Vec3;
use crate::solver::loss::{EnergyGiven, Loss};
use crate::terrain::Terrain;

/// Normal impulse (N s) by which a contact of effective mass `mass` (kg) and normal separation
/// speed `speed` (m/s) gains the kinetic energy `energy_j` (J), in the direction of its motion.
fn impulse(mass: f64, speed: f64, energy_j: f64) -> f64 {
    let after = (speed * speed + 2.0 * energy_j / mass).sqrt();
    mass * (if speed < 0.0 { -after } else { after } - speed)
}

impl IslandBody {
    /// Unloads its contacts with the mesh; the loss (J) is negative.
    pub fn unload(&mut self, terrain: &Terrain) -> Loss {
        let (world, state) = self.with_environment(terrain);
        let mut loss = Loss::default();
        let pressed = state.impact_springs(&world);
        for (n, triangle, energy_j) in pressed {
            state.v += n * (impulse(world.body.mass, n.dot(&state.v), energy_j) / world.body.mass);
            loss.add(&Loss::on_slope([0.0, -energy_j, 0.0]).on(&world, triangle), 1.0);
        }
        self.reset_springs();
        loss
    }

    /// Continues its contacts with springs at rest.
    pub fn reset_springs(&mut self) {
        let state = &mut self.state;
        for history in state.histories.iter_mut() {
            (history.shear, history.roll) = (Vec3::zeros(), Vec3::zeros());
            (history.normal_force, history.onset_m_s) = (0.0, 0.0);
            (history.captured, history.announced, history.impact) = (true, true, 0);
        }
        state.impact.forget();
        state.plane.forget();
        state.upcoming_impacts.clear();
        (state.impact_announced, state.fresh) = (false, false);
        self.last_forces.clear();
    }
}

/// Unloads the contact of two rocks; the energy that each gives (J).
pub fn unload_pair(pair: &mut PairHistory, [a, b]: [&mut IslandBody; 2]) -> [EnergyGiven; 2] {
    let (n, distance) = normal_and_distance(&a.state.c, &b.state.c);
    let depth_m = (a.body.radius + b.body.radius - distance).max(0.0);
    let energy_j = if pair.captured { 0.0 } else { pair.law.stored_j(depth_m, 0.0, 0.0) };
    pair.reset_springs();
    pair.captured = true;
    let mass = a.body.reduced_mass_with(&b.body);
    let push = n * impulse(mass, n.dot(&(a.state.v - b.state.v)), energy_j);
    let work = |one: &mut IslandBody, push: Vec3| {
        let before = one.state.v;
        one.state.v += push / one.body.mass;
        // work of the impulse on the rock, by the mean velocity
        -0.5 * push.dot(&(before + one.state.v))
    };
    EnergyGiven::of_ends([work(a, push), work(b, -push)])
}
