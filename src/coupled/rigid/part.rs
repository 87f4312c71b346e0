//! Rocks that got into each other or into the mesh are moved out, without adding velocity.

use super::Pile;
use super::strike::Scene;
use crate::contact::pair::between;
use crate::coupled::member::Member;
use crate::rock::Vec3;
use crate::step::grip::{TOUCH, World};

/// Overlap of two rocks that is left alone (–, relative to the smaller radius): rest that is swept to a tolerance.
const SLACK: f64 = 1e-5;
/// Sweeps over what overlaps.
const SWEEPS: u32 = 8;

impl Pile {
    /// Moves apart what overlaps, each by its share of the mass; the height that a rock gains is paid by its motion.
    pub(super) fn part(&mut self, scene: &mut Scene) {
        self.places.clear();
        self.places.extend(self.balls.iter().map(|ball| ball.c));
        for _ in 0..SWEEPS {
            let mut moved = false;
            for tie in scene.ties {
                let ends = [tie.a as usize, tie.b as usize];
                let Ok([a, b]) = self.balls.get_disjoint_mut(ends) else { continue };
                let reach = a.body.radius + b.body.radius;
                let allowed = reach - SLACK * a.body.radius.min(b.body.radius);
                if (a.c - b.c).norm_squared() >= allowed * allowed {
                    continue;
                }
                let (n, distance) = between(&a.c, &b.c);
                let way = n * ((reach - distance) / (a.inv.0 + b.inv.0));
                a.c += way * a.inv.0;
                b.c -= way * b.inv.0;
                moved = true;
            }
            for k in 0..self.balls.len() {
                moved |= self.push_out(scene, k);
            }
            if !moved {
                break;
            }
        }
        self.pay_for_height();
    }

    /// Moves a rock out of the mesh; whether it was in it.
    fn push_out(&mut self, scene: &mut Scene, k: usize) -> bool {
        let ball = &mut self.balls[k];
        let Member { grip, body, laws, .. } = &mut *scene.members[k];
        let world = World { terrain: scene.terrain, body: *body, laws };
        grip.look_ahead_again(&world, &ball.c);
        let out = grip.touches.iter().fold(Vec3::zeros(), |sum, touch| {
            let missing = body.radius - touch.distance_m - sum.dot(&touch.normal);
            sum + touch.normal * missing.max(0.0)
        });
        ball.c += out;
        out.norm_squared() > (TOUCH * body.radius).powi(2)
    }

    fn pay_for_height(&mut self) {
        for (ball, from) in self.balls.iter_mut().zip(&self.places) {
            ball.moved = ball.c != *from;
            let lifted = -ball.body.mass * ball.body.gravity.dot(&(ball.c - from));
            let (v2, w2) = (ball.v.norm_squared(), ball.w.norm_squared());
            let motion = 0.5 * (ball.body.mass * v2 + ball.body.inertia * w2);
            if lifted > 0.0 && motion > 0.0 {
                let kept = ((motion - lifted) / motion).max(0.0).sqrt();
                ball.v *= kept;
                ball.w *= kept;
            }
        }
    }
}
