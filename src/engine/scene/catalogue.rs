//! Ground values from literature and from fits with this program, by name, each with its source.
//!
//! Only values that were read in their source or fitted to published measurements stand here. None of the tables of the literature knows
//! contact springs or the friction angle of this law, and those of a fit are part of it: a scene writes them itself.

use crate::ground::Scar;
use crate::random::Distribution;
use std::fmt::{self, Write as _};

/// A ground of the catalogue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownGround {
    /// Name for `like`.
    pub name: &'static str,
    /// What it is.
    pub what: &'static str,
    /// Normal restitution (–).
    pub restitution: KnownValue,
    /// Rolling friction (–); none if the source has none.
    pub rolling_friction: Option<KnownValue>,
    /// Roughness (degrees); none if the source has none.
    pub roughness_deg: Option<KnownValue>,
    /// Soil; none if the source has none.
    pub scar: Option<Scar>,
    /// Of a fit: the values of the scene beside which it holds.
    pub beside: Option<&'static str>,
    /// Where it was read, or what it was fitted to.
    pub source: &'static str,
}

/// A value of the catalogue, drawn once per release.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KnownValue {
    /// The same for every rock.
    Fixed(f64),
    /// Drawn evenly between two ends.
    Uniform([f64; 2]),
    /// From a triangular distribution: least, most frequent, largest.
    Triangular([f64; 3]),
}

impl KnownValue {
    /// As a scene has it.
    pub(super) fn distribution(self) -> Option<Distribution> {
        match self {
            Self::Fixed(value) => Distribution::fixed(value),
            Self::Uniform(ends) => Distribution::uniform(ends),
            Self::Triangular(corners) => Distribution::triangular(corners),
        }
        .ok()
    }
}

impl fmt::Display for KnownValue {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fixed(value) => write!(to, "{value:.3}"),
            Self::Uniform([low, high]) => write!(to, "{low:.3} to {high:.3}"),
            Self::Triangular([low, mode, high]) => {
                write!(to, "{low:.3} to {high:.3} with the peak at {mode:.3}")
            }
        }
    }
}

const STONE: &str = "r.stone manual (GRASS GIS), after Guzzetti et al. 2002 and Alvioli et al. 2021; each value ±10 %";
const CRSP: &str =
    "CRSP 3 values of a site study, Colorado Division of Reclamation, Mining and Safety";

/// What a source does not know.
const NOTHING_ELSE: KnownGround = KnownGround {
    name: "",
    what: "",
    restitution: KnownValue::Fixed(0.0),
    rolling_friction: None,
    roughness_deg: None,
    scar: None,
    beside: None,
    source: "",
};

/// Spheres on the meadow of Tschamut: the values of `examples/tschamut.toml`.
const TSCHAMUT: KnownGround = KnownGround {
    name: "tschamut/meadow",
    what: "meadow below a steep slope, spheres that stand for blocks of 40 to 80 kg",
    restitution: KnownValue::Fixed(0.35),
    rolling_friction: Some(KnownValue::Fixed(0.183_333)),
    roughness_deg: Some(KnownValue::Fixed(30.0)),
    beside: Some("normal_stiffness_n_m = 1e7, tangential_ratio = 0.25, friction_angle_deg = 35.0"),
    source: "fitted with this program to the 80 ends of Tschamut 2014, which leave rolling friction between 0.05 and 0.42 and roughness between 0 and 45° open",
    ..NOTHING_ELSE
};

/// Blocks with their shapes on soil: the values of `examples/tschamut_blocks.toml`.
const SOIL: KnownGround = KnownGround {
    name: "soil/meadow",
    what: "meadow, blocks with shapes ([[rocks.shapes]])",
    restitution: KnownValue::Fixed(0.0),
    scar: Some(Scar { strength_kn_m2: 15000.0, drag: 2.5, soil_density_kg_m3: 1700.0 }),
    beside: Some(
        "normal_stiffness_n_m = 1e7, tangential_ratio = 0.25, friction_angle_deg = 52.4, boxes with corner_radius = 0.275",
    ),
    source: "soil: site means of Lu et al. 2019; friction: largest of the example of Leine et al. 2014; corner radius: fitted with this program to the 80 ends of Tschamut 2014",
    ..NOTHING_ELSE
};

/// A class of r.stone: mean friction and restitution, both drawn within ±10 %.
const fn stone(
    name: &'static str,
    what: &'static str,
    friction: f64,
    restitution: f64,
) -> KnownGround {
    KnownGround {
        name,
        what,
        restitution: KnownValue::Uniform([0.9 * restitution, 1.1 * restitution]),
        rolling_friction: Some(KnownValue::Uniform([0.9 * friction, 1.1 * friction])),
        source: STONE,
        ..NOTHING_ELSE
    }
}

const fn crsp(name: &'static str, what: &'static str, restitution: [f64; 2]) -> KnownGround {
    let restitution = KnownValue::Uniform(restitution);
    KnownGround { name, what, restitution, source: CRSP, ..NOTHING_ELSE }
}

/// All of them.
pub const CATALOGUE: [KnownGround; 12] = [
    stone(
        "rstone/hard-rock",
        "carbonate, lava, intrusive and non-schistose metamorphic rock",
        0.30,
        0.65,
    ),
    stone("rstone/marl-schist", "carbonate and marl sequences, schists", 0.35, 0.60),
    stone(
        "rstone/consolidated-clastic",
        "consolidated clastic rock, marl, flysch, pyroclastic rock",
        0.40,
        0.55,
    ),
    stone("rstone/loose-clastic", "loose clastic rock, mélange, evaporites", 0.35, 0.45),
    stone("rstone/debris", "anthropic, coastal, landslide and glacial deposits", 0.65, 0.35),
    stone("rstone/alluvial", "alluvial, lacustrine and colluvial deposits", 0.80, 0.15),
    stone("rstone/lake-glacier", "lakes and glaciers", 0.95, 0.10),
    crsp("crsp/sandstone", "sandstone cliff and pavement", [0.33, 0.37]),
    crsp("crsp/talus", "talus, upper slope", [0.30, 0.33]),
    crsp("crsp/colluvium", "colluvium, lower slope", [0.28, 0.30]),
    TSCHAMUT,
    SOIL,
];

/// The ground of that name.
pub fn known_ground(name: &str) -> Option<&'static KnownGround> {
    CATALOGUE.iter().find(|ground| ground.name == name)
}

impl KnownGround {
    /// Its values in words.
    pub fn values(&self) -> String {
        let mut text = format!("restitution {}", self.restitution);
        // writing to a string cannot fail
        if let Some(rolling) = self.rolling_friction {
            let _ = write!(text, ", rolling friction {rolling}");
        }
        if let Some(roughness) = self.roughness_deg {
            let _ = write!(text, ", roughness {roughness}°");
        }
        if let Some(Scar { strength_kn_m2, drag, soil_density_kg_m3 }) = self.scar {
            let _ = write!(
                text,
                ", soil of {strength_kn_m2} kN/m² and {soil_density_kg_m3} kg/m³ with a drag of {drag}"
            );
        }
        text
    }

    /// What a scene has to write beside it.
    fn rest(&self) -> String {
        let fitted = |beside| format!("fitted beside {beside}");
        self.beside.map_or_else(|| "tangential ratio: none known".to_owned(), fitted)
    }
}

/// The whole catalogue as a list to read.
pub fn catalogue() -> String {
    let mut text = String::from(
        "Grounds for `like = \"NAME\"` under [grounds.…]. Own values beside it override; springs and friction angle are\n\
         always the scene's own. The tangential restitution of the sources is another law's and has no place in this one, where\n\
         friction takes what slips and tangential_ratio says what an impact that sticks gives back. CRSP lets restitution fall with\n\
         speed (Pfeiffer and Bowen 1989): restitution_half_speed_m_s does so here; its constant was not read in a source and is yours.\n\
         Fitted grounds hold beside the values of the scene that they name; one field test says little about another.\n",
    );
    for ground in &CATALOGUE {
        let KnownGround { name, what, source, .. } = ground;
        let (values, rest) = (ground.values(), ground.rest());
        // writing to a string cannot fail
        let _ =
            write!(text, "\n{name}\n    {what}\n    {values}\n    {rest}\n    source: {source}\n");
    }
    text
}
