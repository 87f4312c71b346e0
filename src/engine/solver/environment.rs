//! Environment of a rock in contact: the terrain, the law of every ground, and its body.

use super::body::Body;
use crate::contact::history::ContactHistory;
use crate::contact::{ContactPoint, TOUCH};
use crate::ground::Law;
use crate::rock::Vec3;
use crate::terrain::Terrain;

/// An approach slower than this is no impact (–, relative to `√(g R)`).
const LEAST_IMPACT: f64 = 1e-3;

/// What stays constant while one rock falls. It is borrowed and copied freely: a few words.
#[derive(Debug, Clone, Copy)]
pub struct ContactEnvironment<'a> {
    /// The mesh.
    pub terrain: &'a Terrain,
    /// The rock.
    pub body: Body,
    /// The law of every ground of the scene for this rock.
    pub laws: &'a [Law],
}

impl<'a> ContactEnvironment<'a> {
    /// The law of a triangle's ground.
    #[inline]
    pub fn law(&self, triangle: u32) -> &'a Law {
        &self.laws[self.ground_of(triangle) as usize]
    }

    /// A triangle's ground.
    #[inline]
    pub(crate) fn ground_of(&self, triangle: u32) -> u16 {
        let sheet = self.terrain.sheet_of[triangle as usize];
        self.terrain.sheets[sheet as usize].ground
    }

    /// Whether a contact is too slow to rebound.
    /// `−n·v < v_capture`: approach along the normal alone; speed along the surface is friction's.
    #[inline]
    pub fn captures(&self, touch: &ContactPoint, v: &Vec3) -> bool {
        -touch.normal.dot(v) < self.law(touch.triangle).capture_m_s
    }

    /// Slowest approach that is resolved as an impact (m/s): slower contacts are part of sustained
    /// contact.
    ///
    /// `√(g R)` is the speed of a rock that falls by half its radius: an approach at a thousandth
    /// of it is part of rolling, not an impact.
    pub(super) fn least_impact_m_s(&self) -> f64 {
        LEAST_IMPACT * self.body.fall_speed_m_s()
    }

    /// Whether the grounds of two triangles have the same springs.
    #[inline]
    pub(super) fn are_alike(&self, one: u32, other: u32) -> bool {
        self.ground_of(one) == self.ground_of(other)
            || self.law(one).has_springs_of(self.law(other))
    }

    /// The law of a contact with `triangle`: springs and dashpots of the ground on which it began,
    /// friction of the ground that it touches. An impact on ground whose restitution falls with
    /// speed has a damping ratio of its own. A combined law is stored in `own`.
    #[inline]
    pub(crate) fn law_touched<'l>(
        &self,
        history: &ContactHistory,
        triangle: u32,
        own: &'l mut Option<Law>,
    ) -> &'l Law
    where
        'a: 'l,
    {
        let (pressed, touched) = (history.springs_of, self.law(triangle));
        if !self.are_alike(pressed, triangle) {
            *own = Some(self.law(pressed).with_friction_of(touched));
        }
        if history.damping_ratio > 0.0 {
            *own = Some(own.as_ref().unwrap_or(touched).damped(history.damping_ratio));
        }
        own.as_ref().unwrap_or(touched)
    }

    /// The law of a contact with the triangle that it touched last.
    #[inline]
    pub(crate) fn springs_of(&self, history: &ContactHistory) -> Law {
        *self.law_touched(history, history.triangle, &mut None)
    }

    /// The law of contact point `k` among others of the same instant, with its history. Patch and
    /// neighbours change the dashpot only through the effective mass `m/|a|²`.
    #[inline]
    pub fn law_of(&self, history: &ContactHistory, touches: &[ContactPoint], k: usize) -> Law {
        let touch = &touches[k];
        let share = self.dashpot_share(touches, k);
        self.law_touched(history, touch.triangle, &mut None).of_patch(touch.gain2, share)
    }

    /// Share of its own damping that the dashpot of contact point `k` keeps among others of the
    /// same instant (–).
    #[inline]
    pub(super) fn dashpot_share(&self, touches: &[ContactPoint], k: usize) -> f64 {
        self.dashpot_share_beside(touches, k, &[])
    }

    /// That share beside `more` contacts, given by their normals.
    #[inline]
    pub(super) fn dashpot_share_beside(
        &self,
        touches: &[ContactPoint],
        k: usize,
        more: &[Vec3],
    ) -> f64 {
        if touches.len() + more.len() == 1 {
            return 1.0;
        }
        // A separating contact counts until its gap exceeds the tolerance: a force that jumps where
        // the gap is zero would force steps as short as the rounding of positions.
        let reach = self.body.radius * (1.0 + TOUCH);
        let pressed =
            touches.iter().enumerate().filter(|(j, other)| *j != k && other.distance_m < reach);
        dashpot_share(&touches[k].normal, pressed.map(|(_, other)| &other.normal).chain(more))
    }
}

/// Share of its own damping that each dashpot keeps where several patches are pressed at once (–):
fn dashpot_share<'a>(normal: &Vec3, others: impl Iterator<Item = &'a Vec3>) -> f64 {
    let along = others.map(|other| normal.dot(other).max(0.0).powi(2));
    1.0 / (1.0 + along.sum::<f64>()).sqrt()
}
