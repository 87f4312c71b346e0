//! Stems that give way in a blow of several rocks.
//!
//! A rock that leans on a stem is pressed against it by all that strikes it. The stem gives way within that blow, and what has not yet run
//! through the row by then finds it gone: the blow is followed with all its rocks until the stem has taken all it can, and goes on from there.

use super::contacts::ImpactScene;
use crate::contact::ContactPoint;
use crate::ground::Law;
use crate::solver::impact::{BODIES, FrozenBody, FrozenContact};
use crate::solver::joint_blow::{
    Breakage, JointBody, JointContact, JointContacts, JointEnd, StemOfRock, joint_blow,
};
use arrayvec::ArrayVec;

/// What a contact with a tree took in a blow: of which rock, by its place in the island, on which triangle, and how much (J).
pub(super) type TakenByTree = (usize, u32, f64);

impl ImpactScene<'_> {
    /// How stems give way to a blow of these `rocks` on all `contacts`, pairs before those with the mesh, if one does.
    pub(super) fn broken_by(
        &self,
        rocks: &[usize],
        bodies: &[FrozenBody],
        contacts: &[FrozenContact],
    ) -> Option<Breakage> {
        let stems = self.terrain.stems.as_ref()?;
        let own_j = |one: &FrozenBody| one.body.motion_j((&one.motion.0, &one.motion.1));
        let motion_j: f64 = bodies.iter().map(own_j).sum();
        let may_break = |&rock: &usize| {
            let state = &self.members[rock].state;
            let yields =
                |at: &ContactPoint| state.stem_load.may_yield_at(stems, at.triangle, motion_j);
            state.touches.iter().any(yields)
        };
        if !rocks.iter().any(may_break) {
            return None;
        }
        let joint: ArrayVec<JointBody, BODIES> =
            bodies.iter().map(|body| body.body.joint(body.motion)).collect();
        let left_j = |(rock, stem): StemOfRock| {
            self.members[rocks[rock]].state.stem_load.left_j(stems, stem)
        };
        joint_blow(&joint, &self.jointly(rocks, bodies, contacts), left_j)
    }

    /// The contacts of a blow with their levers, shares of dashpots and stems.
    fn jointly(
        &self,
        rocks: &[usize],
        bodies: &[FrozenBody],
        contacts: &[FrozenContact],
    ) -> JointContacts {
        let are_pairs = |contact: &&FrozenContact| contact.ends.second.is_some();
        let (pairs, meshes) = contacts.split_at(contacts.iter().take_while(are_pairs).count());
        let of_pair = |contact: &FrozenContact| JointContact {
            law: contact.law.without_rolling(),
            ..frozen_jointly(bodies, contact)
        };
        // rock by rock, as they stand among the contacts
        let touches = rocks.iter().flat_map(|rock| {
            let world = self.members[*rock].environment(self.terrain);
            let state = &self.members[*rock].state;
            let law_of = move |(k, at): (usize, &ContactPoint)| {
                let share = world.dashpot_share(&state.touches, k);
                (world.law(at.triangle).of_patch(at.gain2, share), at.triangle)
            };
            state.touches.iter().enumerate().map(law_of)
        });
        let stems = self.terrain.stems.as_ref();
        let of_mesh = |(contact, (law, triangle)): (&FrozenContact, (Law, u32))| JointContact {
            law,
            stem: stems.and_then(|all| all.of_triangle(triangle)),
            ..frozen_jointly(bodies, contact)
        };
        pairs.iter().map(of_pair).chain(meshes.iter().zip(touches).map(of_mesh)).collect()
    }

    /// Notes what trees took in a blow of these `rocks`, and that these stems have given way to it.
    pub(super) fn load_stems(
        &mut self,
        rocks: &[usize],
        taken: &[TakenByTree],
        broken: &[StemOfRock],
    ) {
        let terrain = self.terrain;
        let Some(stems) = terrain.stems.as_ref() else { return };
        for (place, &rock) in rocks.iter().enumerate() {
            let own = taken.iter().filter(|(of, ..)| *of == rock);
            let gone = broken.iter().filter(|(of, _)| *of == place).map(|(_, stem)| *stem);
            let state = &mut self.members[rock].state;
            if gone.clone().next().is_none() {
                for (_, triangle, joule) in own {
                    state.stem_load.note_impact(terrain, *triangle, *joule);
                }
                continue;
            }
            let struck = own.map(|(_, triangle, joule)| (*triangle, *joule));
            state.remove_stems(stems, struck, gone);
        }
    }
}

/// A contact of a blow, on no stem and alone.
fn frozen_jointly(bodies: &[FrozenBody], contact: &FrozenContact) -> JointContact {
    let (n, levers) = (contact.normal, contact.ends.levers);
    let end =
        |rock: usize, share: f64| JointEnd { rock, lever: n * (share * bodies[rock].body.radius) };
    JointContact {
        n,
        end: end(contact.ends.first, -levers[0]),
        other: contact.ends.second.map(|second| end(second, levers[1])),
        law: *contact.law,
        captured: contact.captured,
        gap_m: contact.gap_m,
        stem: None,
    }
}
