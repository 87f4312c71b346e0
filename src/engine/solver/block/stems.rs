//! Stems that give way to a block.
//!
//! The rule is that of spheres (`solver::stems`): what a block puts into its contacts with a stem counts against what the stem can
//! take; when that is what was left of the stem, the stem is gone and the block goes on. A blow that would take more ends there
//! ([`BlockContact::yielding`](super::solve::BlockContact)).

use super::rolling::Turning;
use super::{Footing, Moving};
use crate::body::Block;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::Loss;
use crate::solver::stems::{WITHSTANDS, given_back};
use crate::terrain::stems::Stems;

impl Footing {
    /// Breaks the stems among the contacts that touch which cannot take the current blow; what they took (J).
    pub(crate) fn break_stems(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        moving: &mut Moving,
    ) -> f64 {
        let Some(stems) = world.terrain.stems.as_ref() else { return 0.0 };
        let mut taken_j = 0.0;
        while let Some((stem, left_j)) = self.break_next(world, stems, (block, moving)) {
            taken_j += left_j;
            self.fell(stem);
            let pose = moving.pose;
            self.look(world, block, &pose, block.ball_m);
        }
        taken_j
    }

    /// Breaks the first stem that cannot take the blow; it, and what was left of it (J).
    fn break_next(
        &self,
        world: &ContactEnvironment,
        stems: &Stems,
        (block, moving): (&Block, &mut Moving),
    ) -> Option<(u32, f64)> {
        let (mass, motion_j) = (moving.mass(block), moving.motion_j(block));
        self.touching(block).find_map(|touch| {
            let stem = stems.of_triangle(touch.triangle)?;
            let left_j = self.stem_load.left_j(stems, stem);
            let u = moving.at(block, &touch.lever);
            if left_j > WITHSTANDS * motion_j || touch.normal.dot(&u) >= 0.0 {
                return None;
            }
            let mut contact = self.contact(world, (&mass, touch), 0.0, Vec3::zeros());
            contact.impulse = contact.yielding(&u, left_j)?;
            moving.take(&[contact], &Turning::NONE, block.mass_kg);
            Some((stem, left_j))
        })
    }

    /// After impulses with these losses: the stem that is touched has taken what went into contacts with trees. Where that is more
    /// than it can, it gives way, and the block gets back what was too much.
    pub(crate) fn bend_stem(
        &mut self,
        world: &ContactEnvironment,
        (block, moving): (&Block, &mut Moving),
        loss: &mut Loss,
    ) {
        let Some(stems) = world.terrain.stems.as_ref().filter(|_| loss.trees > 0.0) else { return };
        // the block may have left what it pressed within the step
        let normal = self.press_stem(world).unwrap_or_else(Vec3::zeros);
        let Some(&(stem, _)) = self.stem_load.pressed.first() else { return };
        if let Some(beyond_j) = self.stem_load.yields(stems, stem, loss.trees) {
            moving.v += given_back(block.mass_kg, &moving.v, beyond_j, &normal);
            self.springs.refresh();
            loss.trees -= beyond_j;
            self.fell(stem);
        }
    }

    /// Notes which stem the contacts of the last look press deepest, and the normal there; as before if they press none.
    pub(crate) fn press_stem(&mut self, world: &ContactEnvironment) -> Option<Vec3> {
        let stems = world.terrain.stems.as_ref()?;
        let touched = self.touches.found.iter().filter_map(|touch| {
            stems.of_triangle(touch.triangle).map(|stem| (stem, touch.gap_m, touch.normal))
        });
        let (stem, _, normal) = touched.min_by(|one, other| one.1.total_cmp(&other.1))?;
        self.stem_load.press(stem);
        Some(normal)
    }

    /// A stem is gone for this block.
    fn fell(&mut self, stem: u32) {
        self.near.gone.push(stem);
        self.near.forget();
        self.stem_load.pressed.clear();
        self.looked = None;
        self.springs.forget_look();
    }
}
