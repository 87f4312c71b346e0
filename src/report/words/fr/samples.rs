//! What is said of samples of rocks and of lines in English, in French.

/// By patterns, as for the plan.
pub(super) const SAMPLES: &[(&str, &str)] = &[
    (
        "rocks of one world meet each other, but all intervals take them for independent and are too narrow for what they share, as how long a heap moves: run several seeds and compare",
        "les blocs d’un même monde se rencontrent\u{a0}: tous les intervalles les prennent pour indépendants et sont trop étroits pour ce qu’ils partagent, comme la durée du mouvement d’un amas\u{a0}; calculer avec plusieurs graines (seed) et comparer",
    ),
    (
        "rocks differ up to {a} times in mass and contacts up to {b} times in stiffness: where the product is more than {c} blows through several contacts are taken one by one, and a boulder on a light stone comes off too slowly; write stiffnesses that are nearer to each other, or scheme = \"adaptive\"",
        "les blocs diffèrent jusqu’à {a} fois en masse et les contacts jusqu’à {b} fois en raideur\u{a0}: où le produit dépasse {c}, les chocs à travers plusieurs contacts sont pris un à un, et un gros bloc sur une pierre légère rebondit trop lentement\u{a0}; écrire des raideurs plus proches, ou scheme = \"adaptive\"",
    ),
    (
        "line “{name}”: its pieces from corner {a} and corner {b} cross; a rock counts once, where it crosses first. Write the corners in order if the line is not meant so",
        "ligne «\u{a0}{name}\u{a0}»\u{a0}: ses tronçons depuis les sommets {a} et {b} se croisent\u{a0}; un bloc compte une fois, là où il la franchit d’abord. Écrire les sommets dans l’ordre si la ligne n’est pas voulue ainsi",
    ),
    (
        "line “{name}”: {a} of its {b} m have no ground below; what comes there is not computed, and its numbers hold for the rest",
        "ligne «\u{a0}{name}\u{a0}»\u{a0}: {a} de ses {b} m n’ont pas de terrain dessous\u{a0}; ce qui y arrive n’est pas calculé, ses chiffres valent pour le reste",
    ),
    (
        "{file}: cells that stand more than {m} m above or below all around them: {n}, the first at ({x}, {y}); errors of measurement, or trees and masts? rocks meet them as ground",
        "{file}\u{a0}: mailles à plus de {m} m au-dessus ou au-dessous de toutes celles qui les entourent\u{a0}: {n}, la première en ({x}, {y})\u{a0}; erreurs de mesure, ou arbres et mâts\u{a0}? les blocs les rencontrent comme sol",
    ),
    (
        "[[objects]] without [frequency]: how many releases hit them is computed, how often a year and at what risk is not",
        "[[objects]] sans [frequency]\u{a0}: combien de départs les touchent est calculé, combien de fois par an et avec quel risque ne l’est pas",
    ),
    (
        "{a} {kind_a} of memory, and about {b} {kind_b} of disk ({files}): {n} release, up to {p} points of paths, {c} cells of maps",
        "{a} {kind_a} de mémoire, et environ {b} {kind_b} de disque ({files})\u{a0}: {n} départ, jusqu’à {p} points de trajectoires, {c} mailles de cartes",
    ),
    (
        "kept for {k} of {n} release, every {t} s",
        "gardées pour {k} {k|départ|départ|départs} sur {n}, toutes les {t} s",
    ),
    ("from one point", "d’un seul point"),
    ("{a} m long, {b} m wide", "longueur {a} m, largeur {b} m"),
    ("{name}: {a} a year of {b} m³, {rest}", "{name}\u{a0}: {a} par an de {b} m³, {rest}"),
    ("{name}: {a} a year of {b} m³", "{name}\u{a0}: {a} par an de {b} m³"),
    ("{a} a year of {b} m³, {rest}", "{a} par an de {b} m³, {rest}"),
    ("{a} a year of {b} m³", "{a} par an de {b} m³"),
    (
        "A name in quotation marks alone stands for the rocks that the barriers of each run have let through to that place: at a barrier those that arrive at it. Those that pass it are a share of all releases.",
        "Un nom seul entre guillemets désigne les blocs que les ouvrages de chaque calcul ont laissés passer jusque-là\u{a0}: à un ouvrage, ceux qui y arrivent. Ceux qui le passent sont une part de tous les départs.",
    ),
    (
        "islands of rocks that may touch, each with its own step; heaps of more than {n} that touch go on as with rigid where none is struck hard: what a spring does within a blow is left out there",
        "îlots de blocs qui peuvent se toucher, chacun avec son pas\u{a0}; les amas de plus de {n} qui se touchent continuent comme avec rigid tant qu’aucun n’est frappé fort\u{a0}: ce que fait un ressort pendant un choc y est omis",
    ),
    (
        "{n} of {tried} releases tried out lie on the line “{name}” before they move: they do not cross it by that, and count only where they come back over it. Draw the line or the release elsewhere",
        "{n} des {tried} départs essayés se trouvent sur la ligne «\u{a0}{name}\u{a0}» avant de bouger\u{a0}: ils ne la franchissent pas pour autant et ne comptent que s’ils la repassent. Dessiner la ligne ou le départ ailleurs",
    ),
    ("left open", "reste ouvert"),
    (
        "TEK17 § 7-3: more often than the safety classes S3 (1), S2 (2), S1 (3) permit",
        "TEK17 § 7-3\u{a0}: plus souvent que ne le permettent les classes de sécurité S3 (1), S2 (2), S1 (3)",
    ),
    // Families of distributions, and units of memory, in places named after them
    ("[uniform]", "loi uniforme"),
    ("[normal]", "loi normale"),
    ("[lognormal]", "loi lognormale"),
    ("[triangular]", "loi triangulaire"),
    ("[listed values]", "valeurs listées"),
    ("[fixed]", "fixe"),
    ("[MB]", "Mo"),
    ("[GB]", "Go"),
    (
        "Direktoratet for byggkvalitet, Byggteknisk forskrift (TEK17) § 7-3, table of the second paragraph: largest nominal annual probability S1 1/100, S2 1/1000, S3 1/5000",
        "Direktoratet for byggkvalitet, Byggteknisk forskrift (TEK17) § 7-3, tableau du deuxième alinéa\u{a0}: plus grande probabilité annuelle nominale S1 1/100, S2 1/1000, S3 1/5000",
    ),
    (
        "The design energy {e} {unit} is that of the design block of {v} m³ ({m} kg without factors) at P{p} of speed, {s} m/s without factors.",
        "L’énergie de dimensionnement {e} {unit} est celle du bloc de projet de {v} m³ ({m} kg sans facteurs) au P{p} de la vitesse, {s} m/s sans facteurs.",
    ),
    (
        "The design energy is P{p} of total energy with the squares of the factors on speed; the standard has that of its design block at P{q} of speed, which block_volume_m3 asks for.",
        "L’énergie de dimensionnement est le P{p} de l’énergie totale avec les carrés des facteurs sur la vitesse\u{a0}; la norme prend celle de son bloc de projet au P{q} de la vitesse, que demande block_volume_m3.",
    ),
    (
        "The capacity must be {f} times that, {e} {unit}.",
        "La capacité doit en être {f} fois, {e} {unit}.",
    ),
    (
        "The standard's factor on the energy of the barrier is not applied: its value is yours, capacity_factor takes it.",
        "Le facteur de la norme sur l’énergie de l’ouvrage n’est pas appliqué\u{a0}: sa valeur revient au projeteur, capacity_factor la reçoit.",
    ),
];
