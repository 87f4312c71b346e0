//! Which values of a rock are only bounds.

use super::super::lines::LineFloor;
use super::super::quantity::Quantity;
use super::super::row::Row;
use super::OpenRock;

/// The quantities of a rock that are bounds only, as it would have gone on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RowBounds([bool; Quantity::ALL.len()]);

impl RowBounds {
    /// Those that energy bounds.
    pub const LARGEST: [Quantity; 5] = [
        Quantity::MaxSpeed,
        Quantity::MaxTranslational,
        Quantity::MaxRotational,
        Quantity::MaxTotal,
        Quantity::MaxHeight,
    ];

    /// Those of one rock. A largest speed, energy or height is none where the rock could not reach a larger one: all energy that it may
    /// still have is that which it ended with and that of its fall to the lowest ground of the terrain, above which its centre stays.
    pub fn of(row: &Row, floor: Option<LineFloor>) -> Self {
        if !row.stop.is_open() {
            return Self::default();
        }
        let open = OpenRock::of(row);
        let most_j = open.zip(floor).map_or(f64::INFINITY, |(rock, floor)| rock.most_j(floor));
        let gravity_m_s2 = floor.map_or(0.0, |floor| floor.gravity_m_s2);
        Self(Quantity::ALL.map(|quantity| {
            let most = most(quantity, (most_j, row.mass_kg), gravity_m_s2);
            quantity.is_bound_after(row.stop) && most.is_none_or(|most| most > quantity.of(row))
        }))
    }

    /// Whether that of a quantity is one.
    pub fn has(self, quantity: Quantity) -> bool {
        self.0[quantity as usize]
    }
}

/// The most that a quantity can become with so much energy (J) over the lowest ground; none where energy does not bound it.
fn most(quantity: Quantity, (most_j, mass_kg): (f64, f64), gravity_m_s2: f64) -> Option<f64> {
    match quantity {
        Quantity::MaxSpeed => Some((2.0 * most_j / mass_kg).max(0.0).sqrt()),
        Quantity::MaxTranslational | Quantity::MaxRotational | Quantity::MaxTotal => Some(most_j),
        Quantity::MaxHeight if gravity_m_s2 > 0.0 => Some(most_j / (mass_kg * gravity_m_s2)),
        _ => None,
    }
}
