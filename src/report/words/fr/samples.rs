//! What is said of samples of rocks in English, in French.

/// By patterns, as for the plan.
pub(super) const SAMPLES: &[(&str, &str)] = &[(
    "rocks of one world meet each other, but all intervals take them for independent and are too narrow for what they share, as how long a heap moves: run several seeds and compare",
    "les blocs d’un même monde se rencontrent\u{a0}: tous les intervalles les prennent pour indépendants et sont trop étroits pour ce qu’ils partagent, comme la durée du mouvement d’un amas\u{a0}; calculer avec plusieurs graines (seed) et comparer",
)];
