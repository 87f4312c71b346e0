//! Exact cases of blocks: a box that slides, one that is thrown by its corners, a prism that rolls from side to side.
//! Corners are rounded, and so are the exact values.

use super::meshes::{angle, plane};
use super::starts::along;
use super::{Case, CaseKind, CaseMeasure, STILL};
use crate::ground::Ground;
use crate::math;
use crate::rock::Vec3;
use crate::study::bench::{BlockForm, MadeBlock, SETUP, Setup, with_springs};
use nalgebra::Rotation3;
use std::f64::consts::{FRAC_PI_3, FRAC_PI_6};

/// Springs so stiff that what they hold of a weight at rest is below all digits (N/m): a face is pressed in by a nanometre.
const STIFF_N_M: f64 = 1e13;

/// A block on ground with this friction (–) and restitution, its springs stiff.
pub(super) fn block(form: BlockForm, ball_m: f64, (friction, restitution): (f64, f64)) -> Setup {
    let block = MadeBlock { form, ball_m, attitude: Rotation3::identity() };
    let ground = Ground {
        friction_angle_rad: math::atan(friction),
        restitution: Some(restitution),
        ..with_springs(SETUP.ground, STIFF_N_M)
    };
    Setup { rock: form.rock(), block: Some(block), ground, ..SETUP }
}

/// The same turned down a slope that falls in +y, its centre so high above it.
pub(super) fn on_slope(setup: &Setup, degrees: f64, height_m: f64) -> Setup {
    let down = math::turn(&Vec3::x_axis(), -angle(degrees));
    let block = setup.block.map(|block| MadeBlock { attitude: down * block.attitude, ..block });
    Setup { block, centre_m: down * Vec3::new(0.0, 0.0, height_m), ..*setup }
}

/// Speed at which the cube starts to slide (m/s), and for how long it slides (s).
const SLIDES_M_S: f64 = 2.0;
const SLIDES_S: f64 = 0.5;

pub(super) const SLIDES: Case = Case {
    name: "box_slides",
    title: "A cube slides on its face down 40° with friction 0.5 from 2 m/s, 0.5 s",
    source: "uniform acceleration g (sin α − μ cos α), no turn; springs of 1e13 N/m are the same to 1e-8",
    kind: CaseKind::Smooth,
    facets: || plane(40.0),
    setup: |_| {
        let lying = on_slope(&block(BlockForm::Box([1.0; 3]), 0.05, (0.5, 0.4)), 40.0, 0.5);
        let (sin, cos) = math::sin_cos(angle(40.0));
        // from rest the friction of springs would grow first
        Setup { velocity_m_s: Vec3::new(0.0, cos, -sin) * SLIDES_M_S, longest_s: SLIDES_S, ..lying }
    },
    exact: Some(|setup, _| {
        let (sin, cos) = math::sin_cos(angle(40.0));
        let speed = SLIDES_M_S + 0.5 * SLIDES_S * setup.gravity_m_s2 * (sin - 0.5 * cos);
        let way = speed * SLIDES_S;
        let mut measures = along(setup, angle(40.0), way);
        measures.push(CaseMeasure {
            what: "spin (rad/s)",
            exact: 0.0,
            scale: 1.0,
            of: |journey| journey.end.spin_rad_s.norm(),
        });
        measures
    }),
    ..STILL
};

/// Radius of the balls of the prism that rolls (m); its sides are 1 m wide.
const ROLLS_BALL_M: f64 = 0.01;

/// Half of a face between its balls, height of the centre over a face, moment of inertia over the mass of the prism.
fn hexagon() -> (f64, f64, f64) {
    (0.5 - ROLLS_BALL_M * math::tan(FRAC_PI_6), 0.75f64.sqrt(), 5.0 / 12.0)
}

/// Spin of the limit cycle before a slap and after it (rad/s): a slap keeps η, and from one to the next the prism rolls on
/// over a face and an arc of its ball.
fn slap(gravity_m_s2: f64) -> [f64; 2] {
    let (half, height, inertia) = hexagon();
    let whole = inertia + height * height + half * half;
    let kept = (whole - 2.0 * half * half) / whole;
    let way = 2.0 * half + ROLLS_BALL_M * FRAC_PI_3;
    let fallen = way * math::sin(angle(10.0));
    let before = (2.0 * gravity_m_s2 * fallen / (whole * (1.0 - kept * kept))).sqrt();
    [before, kept * before]
}

/// Distance of the centre from the line that a slap turns about (m).
fn arm() -> f64 {
    let (half, height, _) = hexagon();
    math::hypot(half, height)
}

pub(super) const ROLLS: Case = Case {
    name: "prism_rolls",
    title: "A hexagonal prism with sides of 1 m rolls down 10° from side to side, friction 1, plastic slaps, 8 s",
    source: "limit cycle of the energy between slaps and of what a slap takes (McGeer's rimless wheel)",
    kind: CaseKind::Slaps,
    facets: || crate::terrain::make::jittered_plane(80.0, 1, angle(10.0)),
    setup: |_| {
        let (half, height, _) = hexagon();
        let flat = block(BlockForm::Prism(6, 1.0), ROLLS_BALL_M, (1.0, 0.0));
        // its axis across the slope
        let across = math::turn(&Vec3::z_axis(), std::f64::consts::FRAC_PI_2);
        let flat = Setup {
            block: flat.block.map(|block| MadeBlock { attitude: across, ..block }),
            ..flat
        };
        let lying = on_slope(&flat, 10.0, height + 1e-7);
        // it has just turned about its rear edge onto the face, a little slower than in the end
        let spin_rad_s = Vec3::x() * -1.7;
        let down = math::turn(&Vec3::x_axis(), -angle(10.0));
        let velocity_m_s = spin_rad_s.cross(&(down * Vec3::new(0.0, half, height)));
        let centre_m = lying.centre_m - down * Vec3::y() * 10.0;
        Setup { centre_m, velocity_m_s, spin_rad_s, longest_s: 8.0, ..lying }
    },
    exact: Some(|setup, _| {
        let [before, after] = slap(setup.gravity_m_s2);
        vec![
            CaseMeasure {
                what: "spin before a slap (rad/s)",
                exact: before,
                scale: before,
                of: |journey| {
                    journey.impacts.last().map_or(f64::NAN, |slap| slap.speed_in_m_s / arm())
                },
            },
            CaseMeasure {
                what: "spin after a slap (rad/s)",
                exact: after,
                scale: before,
                of: |journey| {
                    journey.impacts.last().map_or(f64::NAN, |slap| slap.speed_out_m_s / arm())
                },
            },
        ]
    }),
    ..STILL
};
