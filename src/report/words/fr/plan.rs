//! What the plan says in English, in French.

/// Names of its parts, and what it says of them, by patterns.
pub(super) const PLAN: &[(&str, &str)] = &[
    // Names of the plan's parts
    ("[scene]", "scène"),
    ("[file]", "fichier"),
    ("[version]", "version"),
    ("[releases]", "départs"),
    ("[radius]", "rayon"),
    ("[sizes of table]", "tailles du tableau"),
    ("[lifted]", "soulevés"),
    ("[terrain]", "terrain"),
    ("[input file]", "fichier lu"),
    ("[ground zones]", "zones de sol"),
    ("[map]", "carte"),
    ("[gravity]", "pesanteur"),
    ("[grounds]", "sols"),
    ("[catalogue]", "catalogue"),
    ("[scheme]", "schéma"),
    ("[capture speed]", "vitesse de capture"),
    ("[tangential answer]", "tangentiel"),
    ("[impacts on one plane]", "chocs sur un plan"),
    ("[own dissipation]", "dissipation propre"),
    ("[stop rule]", "règle d’arrêt"),
    ("[trees]", "arbres"),
    ("[breaking stems]", "troncs cassants"),
    ("[flight]", "vol"),
    ("[orientation]", "orientation"),
    ("[shape]", "forme"),
    ("[impacts of blocks]", "chocs des blocs"),
    ("[explicit stages]", "étapes explicites"),
    ("[steps of blocks]", "pas des blocs"),
    ("[cost of shape]", "coût de la forme"),
    ("[flat edges]", "arêtes plates"),
    ("[hollow edges]", "arêtes creuses"),
    ("[corners]", "sommets"),
    ("[rolling friction]", "frott. de roulement"),
    ("[rolling stops]", "roulement arrêté"),
    ("[roughness]", "rugosité"),
    ("[soil]", "terre"),
    ("[rock against rock]", "bloc contre bloc"),
    ("[coupled solve]", "résolution couplée"),
    ("[bonds]", "liaisons"),
    ("[paths]", "trajectoires"),
    ("[impacts]", "impacts"),
    ("[lines]", "lignes"),
    ("[barriers]", "ouvrages"),
    ("[objects]", "objets"),
    ("[frequency]", "fréquence"),
    ("[maps]", "cartes"),
    ("[profile]", "profil"),
    ("[at most]", "au plus"),
    ("[compared with]", "comparé à"),
    ("[warning]", "attention"),
    // What the plan says
    (
        "{n} computed rocks are not compared: their runout is less than least_runout_m of [calibrate], and a list of throws holds none that stayed where it was set down.",
        "{n} blocs calculés ne sont pas comparés\u{a0}: leur distance de propagation est inférieure à least_runout_m de [calibrate], et une liste de lancers n’en contient aucun qui soit resté là où il a été posé.",
    ),
    (
        "measured ends in {file}, without computed rocks whose runout is less than {least} m",
        "des arrêts mesurés dans {file}, sans les blocs calculés dont la distance de propagation est inférieure à {least} m",
    ),
    ("measured ends in {file}", "des arrêts mesurés dans {file}"),
    ("left out: {why}", "hors calcul\u{a0}: {why}"),
    ("leapt over: {why}", "franchi d’un bond\u{a0}: {why}"),
    ("the scene has none", "la scène n’en a pas"),
    ("no ground has any", "aucun sol n’en a"),
    ("releases are independent", "les départs sont indépendants"),
    ("every file has one ground", "chaque fichier a un seul sol"),
    (
        "no ground of trees has breaks_above_j, stems stand for good",
        "aucun sol d’arbres n’a breaks_above_j, les troncs tiennent",
    ),
    (
        "nothing but gravity acts between touches, the parabola is exact",
        "entre les contacts n’agit que la pesanteur, la parabole est exacte",
    ),
    (
        "a sphere looks the same from every side; its spin is computed, how far it has turned is not",
        "une sphère est la même de tous côtés\u{a0}; sa rotation est calculée, son orientation non",
    ),
    (
        "one rock has 6 unknowns, a dense factor is enough",
        "un bloc a 6 inconnues, un facteur plein suffit",
    ),
    (
        "not asked for, [record] impacts = true keeps them",
        "non demandé, [record] impacts = true les garde",
    ),
    ("not asked for, [maps] cell_m = … writes them", "non demandé, [maps] cell_m = … les écrit"),
    (
        "a bond breaks by its springs, and the rigid limit has none",
        "une liaison rompt par ses ressorts, la limite rigide n’en a pas",
    ),
    (
        "neither tensile_strength_pa nor cohesion_pa is above 0",
        "ni tensile_strength_pa ni cohesion_pa ne dépasse 0",
    ),
    (
        "the scene has no [frequency], every number is conditional on release",
        "la scène n’a pas de [frequency], chaque nombre est conditionnel au départ",
    ),
    ("the fixed step knows no other", "le pas fixe n’en connaît pas d’autre"),
    ("every impact is followed step by step", "chaque choc est suivi pas à pas"),
    ("{count} {place}, seed {seed}", "{count} {place}, graine {seed}"),
    ("from {n} points in turn", "de {n} points à tour de rôle"),
    ("along a line of {x} m", "le long d’une ligne de {x} m"),
    ("over an area of {x} m²", "sur une surface de {x} m²"),
    ("over {n} zones of {file}, {how}", "sur {n} zones de {file}, {how}"),
    ("over {n} zones in {m} features of {f}, {how}", "sur {n} zones, {m} objets de {f}, {how}"),
    ("each a source of its own", "chacune une source à part"),
    ("shared by their weights", "réparties selon leurs poids"),
    ("shared by their numbers of points", "réparties selon leurs nombres de points"),
    ("shared by their frequencies", "réparties selon leurs fréquences"),
    ("shared by their lengths", "réparties selon leurs longueurs"),
    ("shared by their areas", "réparties selon leurs surfaces"),
    (
        "{a} m smallest, {b} m median, {c} m largest",
        "{a} m le plus petit, {b} m médian, {c} m le plus grand",
    ),
    ("{n} triangles in 1 file", "{n} triangles dans 1 fichier"),
    ("{n} triangles in {files} files", "{n} triangles dans {files} fichiers"),
    (
        "{file}, {n} bytes; names no system of coordinates: taken as the scene's",
        "{file}, {n} octets\u{a0}; ne nomme pas de système de coordonnées\u{a0}: pris comme celui de la scène",
    ),
    (
        "{file}, {n} bytes; its system “{name}” has no EPSG code: taken as the scene's",
        "{file}, {n} octets\u{a0}; son système «\u{a0}{name}\u{a0}» n’a pas de code EPSG\u{a0}: pris comme celui de la scène",
    ),
    ("{file}, {n} bytes", "{file}, {n} octets"),
    (
        "{n}, {area} m² in plan view; {k} triangles crossed by a border are {how}",
        "{n}, {area} m² en plan\u{a0}; {k} triangles traversés par une limite sont {how}",
    ),
    (
        "cut into {n}, which gives {area} m² their own ground",
        "coupés en {n}, ce qui donne à {area} m² leur propre sol",
    ),
    (
        "left whole, each with the ground at its centroid; so {area} m² have the ground of the other side; cut = true would mend that with {n} triangles",
        "laissés entiers, chacun avec le sol de son centre\u{a0}; ainsi {area} m² ont le sol de l’autre côté\u{a0}; cut = true y remédierait avec {n} triangles",
    ),
    ("origin {place} m subtracted, no EPSG code", "origine {place} m soustraite, pas de code EPSG"),
    ("origin {place} m subtracted, EPSG:{code}", "origine {place} m soustraite, EPSG:{code}"),
    (
        "{name} like {known}: {values} unless written in the scene; {source}",
        "{name} comme {known}\u{a0}: {values} sauf écrit dans la scène\u{a0}; {source}",
    ),
    ("{name}, local error {x} m/s", "{name}, erreur locale {x} m/s"),
    (
        "no corner goes further than {x} of its rounding in one",
        "aucun sommet ne va plus loin que {x} fois son arrondi dans un pas",
    ),
    ("{name}, steps of up to {x} s", "{name}, pas de {x} s au plus"),
    (
        "{name}, steps of {x} s, with shear memory",
        "{name}, pas de {x} s, avec mémoire de cisaillement",
    ),
    (
        "{name}, steps of {x} s, as printed, without shear memory",
        "{name}, pas de {x} s, comme imprimé, sans mémoire de cisaillement",
    ),
    (
        "{x} m/s on {name}, for the median rock: slower impacts do not rebound",
        "{x} m/s sur {name}, pour le bloc médian\u{a0}: les chocs plus lents ne rebondissent pas",
    ),
    (
        "{x} m/s on {name}, given: slower impacts do not rebound",
        "{x} m/s sur {name}, donnée\u{a0}: les chocs plus lents ne rebondissent pas",
    ),
    (
        "{name}: shear over normal spring {ratio}, tangential restitution {back} where an impact sticks",
        "{name}\u{a0}: ressort de cisaillement sur normal {ratio}, restitution tangentielle {back} où un choc adhère",
    ),
    (
        "{name}: shear over normal spring {ratio}",
        "{name}\u{a0}: ressort de cisaillement sur normal {ratio}",
    ),
    ("in no time: the limit of stiff springs", "sans durée\u{a0}: la limite des ressorts raides"),
    (
        "followed as a whole, in their own time; all others step by step",
        "suivis d’un bloc, en leur temps propre\u{a0}; tous les autres pas à pas",
    ),
    (
        "{name}: the scheme itself keeps {all} of the speed; restitution in force",
        "{name}\u{a0}: le schéma garde lui-même {all} de la vitesse\u{a0}; restitution en vigueur",
    ),
    (
        "{name}: the scheme itself keeps {all} of the speed; beside the ground's own restitution",
        "{name}\u{a0}: le schéma garde lui-même {all} de la vitesse\u{a0}; outre la restitution du sol",
    ),
    (
        "at rest after {t} s below {v} m/s in contact; time up after {most} s; over budget after {n} steps and flights",
        "au repos après {t} s sous {v} m/s en contact\u{a0}; temps écoulé après {most} s\u{a0}; budget épuisé après {n} pas et vols",
    ),
    ("{n} triangles", "{n} triangles"),
    (
        "{n}, each whole again for the next rock",
        "{n}, chacun de nouveau entier pour le bloc suivant",
    ),
    ("sphere, weight {n}", "sphère, poids {n}"),
    ("sphere (block {name}), weight {n}", "sphère (bloc {name}), poids {n}"),
    (
        "{name}, weight {n}, its sides drawn for each rock, of which the median: {a} corner balls of {b} R, {c} edges, {d} faces; reaches {e} R, moments of inertia {f} of the sphere's; rounding takes {g} R off its corners",
        "{name}, poids {n}, côtés tirés pour chaque bloc, dont le médian\u{a0}: {a} boules d’angle de {b} R, {c} arêtes, {d} faces\u{a0}; portée {e} R, moments d’inertie {f} de la sphère\u{a0}; l’arrondi ôte {g} R aux angles",
    ),
    (
        "{name}, weight {n}: {a} corner balls of {b} R, {c} edges, {d} faces; reaches {e} R, moments of inertia {f} of the sphere's; rounding takes {g} R off its corners",
        "{name}, poids {n}\u{a0}: {a} boules d’angle de {b} R, {c} arêtes, {d} faces\u{a0}; portée {e} R, moments d’inertie {f} de la sphère\u{a0}; l’arrondi ôte {g} R aux angles",
    ),
    (
        "computed for blocks, free rotation in closed form; left out for spheres, which look the same from every side",
        "calculée pour les blocs, rotation libre sous forme close\u{a0}; laissée de côté pour les sphères, les mêmes de tous côtés",
    ),
    (
        "impacts of blocks, in their own time; those of more than six contacts, and contacts that last, go by implicit stages",
        "chocs de blocs, en leur temps propre\u{a0}; ceux de plus de six contacts, et les contacts qui durent, vont par étapes implicites",
    ),
    (
        "every impact of a block goes by implicit stages",
        "chaque choc d’un bloc va par étapes implicites",
    ),
    (
        "contact by contact, each with springs of its own: its restitution is that of the ground for the mass that it moves",
        "contact par contact, chacun avec ses propres ressorts\u{a0}: sa restitution est celle du sol pour la masse qu’il met en mouvement",
    ),
    (
        "contact by contact, as springs have it in the limit of great stiffness: restitution along the normal for the mass that a contact moves, and along the surface by the ratio of shear to normal stiffness; how stiff they are plays no part",
        "contact par contact, comme des ressorts à la limite des grandes raideurs\u{a0}: restitution selon la normale pour la masse que déplace un contact, et le long de la surface selon le rapport des raideurs de cisaillement et normale\u{a0}; la grandeur de ces raideurs n’intervient pas",
    ),
    (
        "a block is followed corner by corner and edge by edge: time grows with their number",
        "un bloc est suivi angle par angle et arête par arête\u{a0}: le temps croît avec leur nombre",
    ),
    (
        "{k} of {n} left out: the faces beside them touch",
        "{k} sur {n} laissées de côté\u{a0}: les faces voisines touchent",
    ),
    (
        "all kept, however sharp: a rock so deep in a fold that it reaches the edge presses on both sides as one contact",
        "toutes gardées, si vives soient-elles\u{a0}: un bloc si profond dans un pli qu’il atteint l’arête presse les deux côtés en un seul contact",
    ),
    (
        "{k} of {n} left out: {a} between edges that rise and edges that fall, {b} in flat ground; an edge or a face is always nearer",
        "{k} sur {n} laissés de côté\u{a0}: {a} entre des arêtes qui montent et d’autres qui descendent, {b} en sol plan\u{a0}; une arête ou une face est toujours plus proche",
    ),
    (
        "{k} of {n} rows of {file} have a mass_kg that is not that of their radius_m, line {line} the most: {m} kg, but {r} m at {d} kg/m³ weigh {own} kg; {used} is used",
        "{k} des {n} lignes de {file} ont un mass_kg qui n’est pas celui de leur radius_m, surtout la ligne {line}\u{a0}: {m} kg, mais {r} m à {d} kg/m³ pèsent {own} kg\u{a0}; {used} est retenu",
    ),
    (
        "{said}, write [release] size_from = \"mass_kg\" to use the mass, \"radius_m\" to keep the radius",
        "{said}, [release] size_from = \"mass_kg\" retient la masse, \"radius_m\" garde le rayon",
    ),
    (
        "[grounds.{name}] rolling_friction acts on blocks beside their shape, which already holds them back as they roll: keep only what soft ground takes; a value that was fitted to spheres counts the shape twice",
        "[grounds.{name}] rolling_friction agit sur les blocs en plus de leur forme, qui les freine déjà quand ils roulent\u{a0}: n’indiquer que ce que prend un sol mou\u{a0}; une valeur ajustée à des sphères compte la forme deux fois",
    ),
    ("computed", "calculé"),
    (
        "{name}: a block by its shape; on a face, if it does not tip, it stays on slopes of up to {x}° ({a}° to {b}°), the friction angle",
        "{name}\u{a0}: un bloc selon sa forme\u{a0}; posé sur une face, s’il ne bascule pas, il reste sur des pentes jusqu’à {x}° ({a}° à {b}°), l’angle de frottement",
    ),
    (
        "{name}: a block by its shape; on a face, if it does not tip, it stays on slopes of up to {x}°, the friction angle",
        "{name}\u{a0}: un bloc selon sa forme\u{a0}; posé sur une face, s’il ne bascule pas, il reste sur des pentes jusqu’à {x}°, l’angle de frottement",
    ),
    (
        "{name}: on no slope, it has no rolling friction",
        "{name}\u{a0}: sur aucune pente, sans frottement de roulement",
    ),
    (
        "{name}: on slopes of up to {x}° ({a}° to {b}°)",
        "{name}\u{a0}: sur les pentes jusqu’à {x}° ({a}° à {b}°)",
    ),
    ("{name}: on slopes of up to {x}°", "{name}\u{a0}: sur les pentes jusqu’à {x}°"),
    (
        "one facet for every roughness length of the way, leaping, sliding or rolling",
        "une facette par longueur de rugosité du trajet, en sautant, en glissant ou en roulant",
    ),
    (
        "{name}: friction grows with slip, from {a} to {b}",
        "{name}\u{a0}: le frottement croît avec le glissement, de {a} à {b}",
    ),
    (
        "{name}: the median rock that falls on it at {v} m/s digs in {d} m and loses {x} % of its speed on the way",
        "{name}\u{a0}: le bloc médian qui y tombe d’aplomb à {v} m/s s’enfonce de {d} m et perd {x} % de sa vitesse en chemin",
    ),
    (
        "{name}: half of the restitution is left at {v} m/s",
        "{name}\u{a0}: la moitié de la restitution reste à {v} m/s",
    ),
    (
        "one world: {springs}, friction angle {angle}°, restitution of the scheme itself",
        "un seul monde\u{a0}: {springs}, angle de frottement {angle}°, restitution du schéma même",
    ),
    (
        "one world: {springs}, friction angle {angle}°, restitution {e}",
        "un seul monde\u{a0}: {springs}, angle de frottement {angle}°, restitution {e}",
    ),
    ("springs of {a} and {b} N/m", "ressorts de {a} et {b} N/m"),
    (
        "springs left out: the rigid limit has none",
        "ressorts laissés de côté\u{a0}: la limite rigide n’en a pas",
    ),
    (
        "islands of rocks that may touch, each with its own step; impacts in the order of their times, sustained contact swept",
        "îlots de blocs qui peuvent se toucher, chacun avec son pas\u{a0}; chocs dans l’ordre des temps, contact durable par balayages",
    ),
    (
        "islands of rocks that may touch, each with its own step",
        "îlots de blocs qui peuvent se toucher, chacun avec son pas",
    ),
    (
        "between rocks that touch at the start: tensile strength {a} Pa, cohesion {b} Pa",
        "entre blocs qui se touchent au début\u{a0}: résistance à la traction {a} Pa, cohésion {b} Pa",
    ),
    (
        "kept for {k} of {n} releases, every {t} s",
        "gardées pour {k} {k|départ|départ|départs} sur {n}, toutes les {t} s",
    ),
    ("kept", "gardés"),
    (
        "{n}: {all}; crossings exact between stored points",
        "{n}\u{a0}: {all}\u{a0}; passages exacts entre les points enregistrés",
    ),
    (
        "{all}: judged on the rocks that cross, they change no way",
        "{all}\u{a0}: jugés sur les blocs qui passent, ils ne changent aucun parcours",
    ),
    (
        "{all}: hit when the rim of a rock comes over them",
        "{all}\u{a0}: touchés quand le bord d’un bloc vient au-dessus",
    ),
    ("{name} ({a} m long, {b} m wide, {rest})", "{name} (longueur {a} m, largeur {b} m, {rest})"),
    ("{name} ({a} m long, {b} m wide)", "{name} (longueur {a} m, largeur {b} m)"),
    ("{a} m long, {b} m wide, {rest}", "longueur {a} m, largeur {b} m, {rest}"),
    ("{name} ({a} m², {rest})", "{name} ({a} m², {rest})"),
    ("{n} vehicles a day of {l} m at {v} km/h", "{n} véhicules par jour de {l} m à {v} km/h"),
    ("{n} passages a day of one person", "{n} passages par jour d’une personne"),
    ("occupied {x} of the time", "occupé {x} du temps"),
    ("{x} persons", "{x} personnes"),
    ("vulnerability {x}", "vulnérabilité {x}"),
    (
        "{name}: {a} V^-{b} events a year of V m³ or more, {c} to {d} m³",
        "{name}\u{a0}: {a} V^-{b} événements par an de V m³ ou plus, {c} à {d} m³",
    ),
    (
        "{a} V^-{b} events a year of V m³ or more, {c} to {d} m³",
        "{a} V^-{b} événements par an de V m³ ou plus, {c} à {d} m³",
    ),
    (
        "{name}: {a} events a year of the scene's rocks",
        "{name}\u{a0}: {a} événements par an des blocs de la scène",
    ),
    ("{a} events a year of the scene's rocks", "{a} événements par an des blocs de la scène"),
    (
        "{a} events a year; 1 class of size and source: {d} rocks are as precise as {e} of equal weight",
        "{a} événements par an\u{a0}; 1 classe de taille et de source\u{a0}: {d} blocs sont aussi précis que {e} de même poids",
    ),
    (
        "{a} events a year; {b} classes of size and source, {c} rocks or more each: {d} rocks are as precise as {e} of equal weight",
        "{a} événements par an\u{a0}; {b} classes de taille et de source, de {c} blocs ou plus\u{a0}: {d} blocs sont aussi précis que {e} de même poids",
    ),
    (
        "levels of “{name}”; source: {source}",
        "niveaux de «\u{a0}{name}\u{a0}»\u{a0}; source\u{a0}: {source}",
    ),
    (
        "{name}: {a} a year of {b} to {c} m³, {rest}",
        "{name}\u{a0}: {a} par an de {b} à {c} m³, {rest}",
    ),
    ("{a} a year of {b} to {c} m³, {rest}", "{a} par an de {b} à {c} m³, {rest}"),
    ("{a} a year of {b} to {c} m³", "{a} par an de {b} à {c} m³"),
    ("{a} x {b} cells of {c} m", "{a} x {b} mailles de {c} m"),
    (
        "speed and height every {x} m from the release, over all rocks",
        "vitesse et hauteur tous les {x} m depuis le départ, sur tous les blocs",
    ),
    (
        "{a} {kind_a} of memory, and about {b} {kind_b} of disk ({files}): {n} releases, up to {p} points of paths, {c} cells of maps; runs with --yes only",
        "{a} {kind_a} de mémoire, et environ {b} {kind_b} de disque ({files})\u{a0}: {n} départs, jusqu’à {p} points de trajectoires, {c} mailles de cartes\u{a0}; seulement avec --yes",
    ),
    (
        "{a} {kind_a} of memory, and about {b} {kind_b} of disk ({files}): {n} releases, up to {p} points of paths, {c} cells of maps",
        "{a} {kind_a} de mémoire, et environ {b} {kind_b} de disque ({files})\u{a0}: {n} départs, jusqu’à {p} points de trajectoires, {c} mailles de cartes",
    ),
    ("measured ends in {file}", "arrêts mesurés dans {file}"),
    (
        "{a} of {b} releases tried out, over steep ground, by more than a tenth of their radius and up to {c} m, until they just touch: they fall from higher than height_m says",
        "{a} des {b} blocs essayés, au-dessus d’un sol raide, de plus d’un dixième de leur rayon et jusqu’à {c} m, jusqu’à ce qu’ils touchent à peine\u{a0}: ils tombent de plus haut que ne le dit height_m",
    ),
    (
        "the same number of rocks is computed for every source, however often it releases them in a year. Percentiles, shares and maps are weighted back and hold for the sources as they are; counts of rocks and dots in figures show rocks as computed",
        "autant de blocs sont calculés pour chaque source, quel que soit le nombre qu’elle en libère par an. Centiles, parts et cartes sont repondérés et valent pour les sources telles quelles\u{a0}; nombres de blocs et points des figures montrent les blocs calculés",
    ),
];
