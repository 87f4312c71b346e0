//! One rock in contact, without the flights in between.

use super::Case;
use rockfall::ground::{Capture, Damping, Law};
use rockfall::rock::Vec3;
use rockfall::solver::body::Body;
use rockfall::solver::contact_state::{ContactEnvironment, ContactState};
use rockfall::solver::{Settings, Stepper, advance};
use rockfall::terrain::Terrain;

/// One rock in contact, stepped by hand.
pub struct Episode<'a> {
    terrain: &'a Terrain,
    laws: [Law; 1],
    body: Body,
    settings: Settings,
}

impl<'a> Episode<'a> {
    /// A case's rock and ground under gravity (m/s²).
    pub fn new(terrain: &'a Terrain, case: &Case, gravity_m_s2: f64) -> Self {
        let capture = Capture { own_m_s: None, tolerance_m_s: 0.0, gravity_m_s2 };
        let damping = Damping::of(case.ground.restitution);
        let settings = Settings {
            scheme: case.scheme,
            tolerance_m_s: case.tolerance_m_s,
            step_s: case.step_s,
            shear_memory: case.shear_memory,
            impact_kernels: case.impact_kernels,
            rigid_heaps: true,
            corner_way: rockfall::solver::CORNER_WAY,
            capture_speed_m_s: None,
        };
        Self {
            terrain,
            laws: [Law::new(&case.ground, &damping, &case.rock, &capture)],
            body: Body::new(&case.rock, gravity_m_s2),
            settings,
        }
    }

    /// Takes steps until the rock is free or `steps` are done; `see` looks at each.
    pub fn run(
        &self,
        [c, v, w]: [[f64; 3]; 3],
        steps: usize,
        mut see: impl FnMut(&ContactEnvironment, &ContactState),
    ) -> ContactState {
        let world = ContactEnvironment { terrain: self.terrain, body: self.body, laws: &self.laws };
        let mut grip = ContactState::default();
        grip.begin(&world, Vec3::from(c) - self.terrain.origin_m, v.into(), w.into());
        let mut stepper = Stepper::new(&self.settings, &world, &mut grip);
        for _ in 0..steps {
            advance(&mut stepper, &world, &mut grip, f64::INFINITY).unwrap();
            see(&world, &grip);
            if grip.is_free() {
                break;
            }
        }
        grip
    }
}
