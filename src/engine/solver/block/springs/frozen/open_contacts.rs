//! Contacts that open within an impact and close again.

use super::{BlockContactState, CONTACTS, FrozenFlow, PER_CONTACT, SpringContact};
use crate::rock::Vec3;
use crate::solver::impact::dormand_prince::put_vec3;
use crate::solver::law::capture_m_s;

impl FrozenFlow<'_, '_> {
    /// Share of a step from `y` to `end` at which the first open contact closes again (–), unless
    /// that is at its very end.
    pub(super) fn recontact_share<const N: usize>(
        &self,
        y: &[f64; N],
        end: &[f64; N],
    ) -> Option<f64> {
        let onset_m = self.onset_m();
        let waits = self.contacts.iter().enumerate().filter(|(_, contact)| contact.is_suspended);
        let back = waits.filter_map(|(k, _)| {
            let [x, reached] = [y, end].map(|y| y[CONTACTS + PER_CONTACT * k]);
            let share = (0.5 * onset_m - x) / (reached - x);
            // a contact that opened while it was pressed in has no onset on this path
            (x < 0.0 && reached > onset_m).then_some(share)
        });
        back.reduce(f64::min)
    }

    /// Updates which contacts are open; returns whether one has closed again.
    pub(super) fn update_open<const N: usize>(&mut self, y: &mut [f64; N]) -> bool {
        let mut is_back = false;
        for k in 0..self.contacts.len() {
            let at = CONTACTS + PER_CONTACT * k;
            if self.contacts[k].is_suspended && y[at] >= 0.0 {
                let closes = self.contacts[k].n.dot(&self.point_m_s(k, y)) < 0.0;
                if closes {
                    self.recontact(k, y);
                }
                is_back |= closes;
            } else if !self.contacts[k].is_suspended
                && y[at] <= 0.0
                && self.contacts[k].normal_force <= 0.0
            {
                self.contacts[k].is_suspended = true;
                // the energy of its spring is lost
                put_vec3(y, at + 1, &Vec3::zeros());
            }
        }
        is_back
    }

    /// Restarts a contact that closes again, with the dashpot of its speed and its share among the
    /// contacts that touch with it.
    pub(super) fn recontact<const N: usize>(&mut self, k: usize, y: &mut [f64; N]) {
        let at = CONTACTS + PER_CONTACT * k;
        let touch = &self.touches[k];
        let approach_m_s = -touch.normal.dot(&self.point_m_s(k, y));
        let others = self.touches.iter().enumerate();
        let others =
            others.filter(|(j, _)| !self.contacts[*j].is_suspended).map(|(_, other)| other);
        let law =
            BlockContactState::law_of_touch(self.world, &self.mass, touch, (approach_m_s, others));
        let friction = self.contacts[k].law.friction_coefficient();
        let rebounds = self
            .contacts
            .iter()
            .any(|one| !one.is_suspended && !one.captured && one.normal_force > 0.0);
        let mut contact = SpringContact::just_touching((k, touch), &law, friction);
        contact.captured = approach_m_s < capture_m_s(&law) && !rebounds;
        self.contacts[k] = contact;
        y[at] = y[at].max(0.0);
        put_vec3(y, at + 1, &Vec3::zeros());
    }
}
