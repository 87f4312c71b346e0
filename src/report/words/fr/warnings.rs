//! What plan and run warn of in English, in French.

/// By patterns, as for the plan.
pub(super) const WARNINGS: &[(&str, &str)] = &[
    ("[grounds.{name}] lies under no mesh", "[grounds.{name}] n’est sous aucun maillage"),
    (
        "[grounds.{name}] has breaks_above_j, but no tree: only trees give way",
        "[grounds.{name}] a breaks_above_j, mais aucun arbre\u{a0}: seuls les arbres cèdent",
    ),
    (
        "[grounds.{name}] like {known}: its source has no rolling friction, and without any nothing stops a sphere that rolls; write rolling_friction",
        "[grounds.{name}] like {known}\u{a0}: sa source n’a pas de frottement de roulement, et sans lui rien n’arrête une sphère qui roule\u{a0}; écrire rolling_friction",
    ),
    (
        "capture_speed_m_s = {a} is below half the tolerance of {b} m/s: slow rocks may flutter and never come to rest; write {c} or more",
        "capture_speed_m_s = {a} est au-dessous de la moitié de la tolérance de {b} m/s\u{a0}: des blocs lents peuvent trembler sans jamais s’arrêter\u{a0}; écrire {c} ou plus",
    ),
    (
        "{where} omega * step_s = {x} for a rock of {r} m, which is thrown back within one step, the livelier the longer the step: write a step_s below {y}",
        "{where} omega * step_s = {x} pour un bloc de {r} m, qui est renvoyé en un seul pas, d’autant plus vivement que le pas est long\u{a0}: écrire step_s au-dessous de {y}",
    ),
    (
        "step_s = {a} lets a rock fall for {b} s at most before its budget of {c} steps is spent; write a longer step, or a longest_s below that",
        "step_s = {a} laisse tomber un bloc {b} s au plus avant que son budget de {c} pas soit épuisé\u{a0}; écrire un pas plus long, ou un longest_s plus court",
    ),
    (
        "{a} % of the places drawn for {n} releases have no ground or no room for the rock (a hole, a tree, the edge of the terrain): such a place is drawn again",
        "{a} % des lieux tirés pour {n} départs n’ont pas de sol ou pas de place pour le bloc (un trou, un arbre, le bord du terrain)\u{a0}: un tel lieu est tiré à nouveau",
    ),
    (
        "{a} of {n} releases tried out find no place to start from: each has a row with the stop reason not_released and counts in no statistic",
        "{a} départs sur {n} essayés ne trouvent aucun lieu de départ\u{a0}: chacun a une ligne avec la fin not_released et ne compte dans aucune statistique",
    ),
    (
        "{n} releases over {k} classes of size and source: with fewer than {few} each the intervals a year may be too narrow; write count = {c} or more",
        "{n} départs pour {k} classes de taille et de source\u{a0}: avec moins de {few} par classe, les intervalles par an peuvent être trop étroits\u{a0}; écrire count = {c} ou plus",
    ),
    ("no ground below", "aucun sol dessous"),
    ("in the ground or a tree", "dans le sol ou dans un arbre"),
    ("1/year", "1/a"),
    (
        "{who}: the rocks of one world meet each other, but all intervals take them for independent and are too narrow for what they share: a change that is clear here may be chance. Run several seeds of each scene and compare.",
        "{who}\u{a0}: les blocs d’un même monde se rencontrent, mais tous les intervalles les prennent pour indépendants et sont trop étroits pour ce qu’ils partagent\u{a0}: une variation significative ici peut être due au hasard. Calculer avec plusieurs graines (seed) de chaque scène et comparer.",
    ),
    (
        "{file} says how large the rocks of its zones are, which is not used: sizes are those of the scene; where each zone says how often too, and [frequency] has no law of its own, each has its own",
        "{file} dit la taille des blocs de ses zones, qui n’est pas utilisée\u{a0}: les tailles sont celles de la scène\u{a0}; si chaque zone dit aussi la fréquence et que [frequency] n’a pas de loi propre, chacune a les siennes",
    ),
    (
        "in the fit on all {n} of {of} computed rocks ({share} %) had not ended, {left} had left the terrain, {moving} were still moving: mean runouts and shares are at least what is said, KS distances and intervals hold however these rocks would have ended; write {what}",
        "dans le calage sur tous, {n} blocs calculés sur {of} ({share} %) n’étaient pas arrivés, {left} étaient sortis du terrain, {moving} bougeaient encore\u{a0}: les distances moyennes et les parts valent au moins ce qui est dit, les distances KS et les intervalles valent quel qu’eût été l’arrêt de ces blocs\u{a0}; écrire {what}",
    ),
    (
        "{name}: rocks that had not ended leave open which values fit best, as far as to the lower end of the range tried, {a}; write a longer longest_s or a larger terrain before a smaller from in vary",
        "{name}\u{a0}: des blocs qui n’étaient pas arrivés laissent ouvert quelles valeurs conviennent le mieux, jusqu’au bas de l’intervalle essayé, {a}\u{a0}; écrire un longest_s plus long ou un terrain plus étendu avant d’écrire dans vary un from plus petit",
    ),
    (
        "{name}: rocks that had not ended leave open which values fit best, as far as to the upper end of the range tried, {a}; write a longer longest_s or a larger terrain before a larger to in vary",
        "{name}\u{a0}: des blocs qui n’étaient pas arrivés laissent ouvert quelles valeurs conviennent le mieux, jusqu’au haut de l’intervalle essayé, {a}\u{a0}; écrire un longest_s plus long ou un terrain plus étendu avant d’écrire dans vary un to plus grand",
    ),
    ("a larger terrain", "un terrain plus étendu"),
    ("a longer longest_s", "un longest_s plus long"),
    ("a longer longest_s and a larger terrain", "un longest_s plus long et un terrain plus étendu"),
    (
        "{name}: the values that fit best reach the lower end of the range tried, {a}, and better ones may lie below it; write a smaller from in vary",
        "{name}\u{a0}: les valeurs qui conviennent le mieux atteignent le bas de l’intervalle essayé, {a}, et de meilleures peuvent se trouver au-dessous\u{a0}; écrire dans vary un from plus petit",
    ),
    (
        "{name}: the values that fit best reach the upper end of the range tried, {a}, and better ones may lie above it; write a larger to in vary",
        "{name}\u{a0}: les valeurs qui conviennent le mieux atteignent le haut de l’intervalle essayé, {a}, et de meilleures peuvent se trouver au-dessus\u{a0}; écrire dans vary un to plus grand",
    ),
    (
        "the values tried do not explain the measured ends: KS distance {a} of the fit on all, 5 % limit {b}; write wider ranges in vary, vary other values, or look at terrain, rocks and releases",
        "les valeurs essayées n’expliquent pas les arrêts mesurés\u{a0}: distance KS {a} du calage sur tous, limite à 5 % {b}\u{a0}; écrire dans vary des intervalles plus larges, varier d’autres valeurs, ou revoir terrain, blocs et départs",
    ),
    (
        "{file}: {n} of {of} stems do not stand on the slope: {a} with their foot more than 0.5 m above it, {b} with their top under it, {c} beside it; rocks meet them in the wrong place or not at all. Export the file in the coordinates and heights of the terrain, or look at its scale and up",
        "{file}\u{a0}: {n} tiges sur {of} ne se dressent pas sur la pente\u{a0}: {a} avec le pied à plus de 0.5 m au-dessus, {b} avec la cime au-dessous, {c} à côté\u{a0}; les blocs les rencontrent au mauvais endroit ou pas du tout. Exporter le fichier dans les coordonnées et altitudes du terrain, ou revoir scale et up",
    ),
    (
        "trees: none of {n} rocks touched one; do they stand where the rocks come?",
        "arbres\u{a0}: aucun des {n} blocs n’en a touché un\u{a0}; sont-ils là où viennent les blocs\u{a0}?",
    ),
    (
        "{file}: its map coordinates are written in steps of {a}, {b} % of the median edge {c}, and {n} of its {m} facets have no area: where they were rounded, slopes are wrong; export it with three decimals or more, or with a map origin subtracted and origin_m in the scene",
        "{file}\u{a0}: ses coordonnées sont écrites par pas de {a}, {b} % de l’arête médiane {c}, et {n} de ses {m} triangles sont sans surface\u{a0}: là où elles ont été arrondies, les pentes sont fausses\u{a0}; l’exporter avec trois décimales ou plus, ou avec une origine soustraite et origin_m dans la scène",
    ),
    (
        "{file}: its map coordinates are written in steps of {a}, {b} % of the median edge {c}: where they were rounded, slopes are wrong; export it with three decimals or more, or with a map origin subtracted and origin_m in the scene",
        "{file}\u{a0}: ses coordonnées sont écrites par pas de {a}, {b} % de l’arête médiane {c}\u{a0}: là où elles ont été arrondies, les pentes sont fausses\u{a0}; l’exporter avec trois décimales ou plus, ou avec une origine soustraite et origin_m dans la scène",
    ),
    (
        "{n} of {all} triangles have no area and are left out: what is left is hardly the terrain; does the file have too few digits?",
        "{n} triangles sur {all} sont sans surface et laissés de côté\u{a0}: ce qui reste n’est guère le terrain\u{a0}; le fichier a-t-il trop peu de chiffres\u{a0}?",
    ),
    (
        "{file}: properties that are not used: {names}; zones have {known}",
        "{file}\u{a0}: propriétés qui ne sont pas utilisées\u{a0}: {names}\u{a0}; les zones ont {known}",
    ),
    (
        "{a} % of the places drawn for {n} releases have no ground or no room for the rock (a hole, a tree, the edge of the terrain; {b} % on ground so steep that no height is clear of it): such a place is drawn again",
        "{a} % des lieux tirés pour {n} départs n’ont pas de sol ou pas de place pour le bloc (un trou, un arbre, le bord du terrain\u{a0}; {b} % sur un sol si raide qu’aucune hauteur n’en est libre)\u{a0}: un tel lieu est tiré à nouveau",
    ),
    (
        "[[barriers]] \"{name}\" height_m = {a} is higher than any net; is it in cm? write {b}",
        "[[barriers]] \"{name}\" height_m = {a} est plus haut que tout filet\u{a0}; en cm\u{a0}? écrire {b}",
    ),
    (
        "[[barriers]] \"{name}\" height_m = {a} is higher than any net; the tallest in use have about 10 m",
        "[[barriers]] \"{name}\" height_m = {a} est plus haut que tout filet\u{a0}; les plus hauts en service ont environ 10 m",
    ),
    (
        "{file}: {n} of {of} stems are left out, as no ground lies below them, the first in line {row} at ({x}, {y}): beside the slope as it is cropped, or over a hole. Where they should stand, look at crop, at the coordinates of the list and at holes of the slope",
        "{file}\u{a0}: {n} tiges sur {of} sont laissées de côté, car il n’y a pas de sol sous elles, la première à la ligne {row} en ({x}, {y})\u{a0}: à côté de la pente telle qu’elle est découpée, ou sur un trou. Là où elles devraient se dresser, revoir crop, les coordonnées de la liste et les trous de la pente",
    ),
    (
        "{file}: {n} of {of} stems are left out, as no ground lies below them, the first as feature {row} at ({x}, {y}): beside the slope as it is cropped, or over a hole. Where they should stand, look at crop, at the coordinates of the list and at holes of the slope",
        "{file}\u{a0}: {n} tiges sur {of} sont laissées de côté, car il n’y a pas de sol sous elles, la première étant l’objet {row} en ({x}, {y})\u{a0}: à côté de la pente telle qu’elle est découpée, ou sur un trou. Là où elles devraient se dresser, revoir crop, les coordonnées de la liste et les trous de la pente",
    ),
    (
        "{n} of {m} releases tried out start more than 100 m above the ground, up to {h} m: do the heights of the releases and of the slope belong together, with their sign?",
        "{n} départs sur {m} essayés commencent à plus de 100 m au-dessus du sol, jusqu’à {h} m\u{a0}: les altitudes des départs et de la pente vont-elles ensemble, avec leur signe\u{a0}?",
    ),
    (
        "none of {n} rocks touched the ground: do the places and heights of the releases belong to this slope?",
        "aucun des {n} blocs n’a touché le sol\u{a0}: les lieux et altitudes des départs appartiennent-ils à cette pente\u{a0}?",
    ),
    ("{line}: 0 of {n} rocks of {class}", "{line}\u{a0}: 0 bloc sur {n} de {class}"),
    (
        "holes in the slope: {n}, the largest of {a} m² near ({x}, {y}); rocks that come there leave the terrain: fill them",
        "trous dans la pente\u{a0}: {n}, le plus grand de {a} m² près de ({x}, {y})\u{a0}; les blocs qui y arrivent sortent du terrain\u{a0}: les combler",
    ),
    (
        "single corners far above or below all around them: {n}, the farthest by {a} m at ({x}, {y}); errors of measurement, or trees and masts? rocks meet them as ground",
        "sommets isolés loin au-dessus ou au-dessous de tout ce qui les entoure\u{a0}: {n}, le plus éloigné de {a} m en ({x}, {y})\u{a0}; erreurs de mesure, ou arbres et mâts\u{a0}? les blocs les touchent comme du sol",
    ),
    (
        "sheets that hang above another part of the slope: {n}, the largest of {a} m², {b} m above it near ({x}, {y}); rocks meet them as ground: leave them out if they are none",
        "nappes suspendues au-dessus d’une autre partie de la pente\u{a0}: {n}, la plus grande de {a} m², {b} m au-dessus près de ({x}, {y})\u{a0}; les blocs les touchent comme du sol\u{a0}: les ôter si elles n’en sont pas",
    ),
];
