use super::*;
use crate::random::{Purpose, stream, unit};

/// Corners of a face whose goals along the surface no motion of a rigid body reaches together: sweeps alone do not settle in one solve of ten,
/// with goals that agree nearly all do. None pulls or bears more than its friction, and what settles alone stays as it was.
#[test]
fn goals_that_contradict_each_other_settle() {
    let inverse = Matrix3::from_diagonal(&Vec3::new(2.5, 3.5, 2.0));
    let mass = Mass { mass: 1.0, inverse };
    let corners = [[0.6, 0.5, -0.3], [-0.6, 0.5, -0.3], [-0.6, -0.5, -0.3], [0.6, -0.5, -0.3]];
    let (mut alone, mut agreed) = (0, 0);
    for k in 0..2000 {
        let mut random = stream(7, Purpose::Shape, k);
        let mut draw = |half: f64| half * (2.0 * unit(&mut random) - 1.0);
        let contact = |corner: &[f64; 3]| {
            let goal = Vec3::new(draw(1e-3), draw(1e-3), 0.0);
            let friction = (0.6 + draw(0.3), 0);
            BlockContact::new(&mass, (Vec3::z(), Vec3::from(*corner)), friction, goal)
        };
        let contacts: Vec<BlockContact> = corners.iter().take(3 + k % 2).map(contact).collect();
        let falls = Vec3::new(draw(0.5), draw(0.5), -1.0);
        let free = (falls, Vec3::new(draw(0.3), draw(0.3), draw(1.0)));
        let mut footing = Footing { contacts: contacts.clone(), ..Footing::default() };
        let (mut plain, mut turning) = (contacts, Turning::NONE);
        let asked = (&mut plain[..], &mut turning);
        let settled = solve(&mass, asked, free, (1e-15, SWEEPS), &mut 0);
        let reached = footing.solve_reachable(&mass, free, 1e-15);
        let same = |(a, b): (&BlockContact, &BlockContact)| a.impulse == b.impulse;
        assert!(!settled || reached && plain.iter().zip(&footing.contacts).all(same));
        alone += usize::from(!settled);
        agreed += usize::from(!reached);
        for contact in &footing.contacts {
            let push = contact.n.dot(&contact.impulse);
            let drag = (contact.impulse - contact.n * push).norm();
            assert!(push >= 0.0 && drag <= contact.friction * push * (1.0 + 1e-9) + 1e-12);
        }
    }
    assert!(alone > 200 && agreed < 5, "{alone} {agreed}");
}
