//! What the program records in English but the plan, and texts of the view, in French.

/// What the program records but the plan, by patterns.
pub(super) const RECORDED: &[(&str, &str)] = &[
    // What it warns of
    (
        "{where} omega * step_s = {x} for a rock of {r} m, which does not resolve its impacts: write a step_s below {y}",
        "{where} omega * step_s = {x} pour un bloc de {r} m, ce qui ne résout pas ses chocs\u{a0}: écrire un step_s sous {y}",
    ),
    (
        "{where} normal_stiffness_n_m = {k} lets a rock of {r} m sink in by more than 0.1 of its radius in impacts above {v} m/s; {need} would hold it up to {most} m/s",
        "{where} normal_stiffness_n_m = {k} laisse un bloc de {r} m s’enfoncer de plus de 0.1 de son rayon dans les chocs au-dessus de {v} m/s\u{a0}; {need} le tiendrait jusqu’à {most} m/s",
    ),
    (
        "{where} normal_stiffness_n_m = {k} lets a rock of {r} m sink in by more than 0.3 of its corners' radius in impacts above {v} m/s; {need} would hold it up to {most} m/s",
        "{where} normal_stiffness_n_m = {k} laisse un bloc de {r} m s’enfoncer de plus de 0.3 du rayon de ses coins dans les chocs au-dessus de {v} m/s\u{a0}; {need} le tiendrait jusqu’à {most} m/s",
    ),
    (
        "{file} says how often its zones release rocks, and the scene asks for nothing a year: write the table [frequency], and each zone is a source",
        "{file} dit à quelle fréquence ses zones libèrent des blocs, et la scène ne demande rien par an\u{a0}: écrire la table [frequency], et chaque zone est une source",
    ),
    (
        "sizes are sampled by importance: large rocks are computed more often than they come. Percentiles, shares and maps are weighted back and hold for the sources as they are; counts of rocks and dots in figures show rocks as computed",
        "les tailles sont tirées par importance\u{a0}: les gros blocs sont calculés plus souvent qu’ils ne viennent. Centiles, parts et cartes sont repondérés et valent pour les sources telles quelles\u{a0}; nombres de blocs et points des figures montrent les blocs calculés",
    ),
    (
        "{a} of {b} rocks failed: they count as far as they came; `--only {c}` shows one again",
        "{a} blocs sur {b} ont échoué\u{a0}: ils comptent jusqu’où ils sont venus\u{a0}; `--only {c}` en remontre un",
    ),
    (
        "source “{a}”: no rock of {b} of its {c} events a year was released: they are missing in every number",
        "source “{a}”\u{a0}: aucun bloc n’est parti pour {b} de ses {c} événements par an\u{a0}: ils manquent dans tous les nombres",
    ),
    (
        "{a} of {b} rocks were not released, {why}: they are counted, but in no statistic; the first is release {c}",
        "{a} blocs sur {b} ne sont pas partis, {why}\u{a0}: comptés, mais dans aucune statistique\u{a0}; le premier est le départ {c}",
    ),
    (
        "{a} of {b} rocks were still moving when their budget of work was spent: they count as far as they came; `--only {c}` shows one again",
        "{a} blocs sur {b} bougeaient encore quand leur budget de calcul fut épuisé\u{a0}: ils comptent jusqu’où ils sont venus\u{a0}; `--only {c}` en remontre un",
    ),
    (
        "barrier “{name}”: {a} of {b} arriving rocks cross it where the terrain has a hole: their height is not known, and they count as passing over it; fill the hole",
        "ouvrage “{name}”\u{a0}: {a} des {b} blocs qui arrivent le franchissent là où le terrain a un trou\u{a0}: leur hauteur est inconnue, ils comptent comme passant par-dessus\u{a0}; combler le trou",
    ),
    (
        "{a} of {b} contact steps did not settle: their contact forces do not agree with their motion; take a smaller tolerance_m_s, step_s or corner_way, whichever the scheme has",
        "{a} pas de contact sur {b} ne se sont pas stabilisés\u{a0}: leurs forces ne s’accordent pas à leur mouvement\u{a0}; prendre tolerance_m_s, step_s ou corner_way plus petit, selon le schéma",
    ),
    (
        "the computation itself lost {x} % of the energy released, beside friction and damping; take a smaller tolerance or step, or scheme \"reference\"",
        "le calcul lui-même a perdu {x} % de l’énergie libérée, outre frottement et amortissement\u{a0}; prendre une tolérance ou un pas plus petit, ou le schéma \"reference\"",
    ),
    (
        "the computation itself gained {x} % of the energy released, beside friction and damping; take a smaller tolerance or step, or scheme \"reference\"",
        "le calcul lui-même a gagné {x} % de l’énergie libérée, outre frottement et amortissement\u{a0}; prendre une tolérance ou un pas plus petit, ou le schéma \"reference\"",
    ),
    (
        "release {a}: its mechanical energy rose by {x} J in one contact; take a smaller tolerance or step",
        "départ {a}\u{a0}: son énergie mécanique a crû de {x} J en un contact\u{a0}; prendre une tolérance ou un pas plus petit",
    ),
    // What went in
    ("Rock density", "Masse volumique des blocs"),
    ("Rock radius", "Rayon des blocs"),
    ("Release above the ground", "Départ au-dessus du sol"),
    ("Velocity at release (x | y | z)", "Vitesse au départ (x | y | z)"),
    ("Spin at release (x | y | z)", "Rotation au départ (x | y | z)"),
    ("Ground “{name}”", "Sol «\u{a0}{name}\u{a0}»"),
    ("Trees “{name}”", "Arbres «\u{a0}{name}\u{a0}»"),
    ("Source “{name}”", "Source «\u{a0}{name}\u{a0}»"),
    ("Object “{name}”", "Objet «\u{a0}{name}\u{a0}»"),
    ("by the volumes of the sources, see below", "selon les volumes des sources, voir plus bas"),
    ("springs {a} normal, {b} along the surface", "ressorts {a} normaux, {b} tangents"),
    ("{a} times that", "{a} fois autant"),
    ("friction angle {a}", "angle de frottement {a}"),
    ("restitution {a}", "restitution {a}"),
    ("rolling friction {a}", "frottement de roulement {a}"),
    ("roughness length {a}", "longueur de rugosité {a}"),
    ("roughness {a}", "rugosité {a}"),
    ("gives way above {a}", "cède au-dessus de {a}"),
    (
        "friction grows with slip to {a}, κ {b} 1/m, forgotten with {c} 1/s",
        "le frottement croît avec le glissement jusqu’à {a}, κ {b} 1/m, oublié avec {c} 1/s",
    ),
    (
        "soil of {a} kN/m² and {b} kg/m³, drags with C = {c}",
        "terre de {a} kN/m² et {b} kg/m³, freine avec C = {c}",
    ),
    ("half of the restitution is left at {a}", "la moitié de la restitution reste à {a}"),
    (
        "{a} ({b} to {c} in nine of ten, {kind}) {unit}",
        "{a} ({b} à {c} neuf fois sur dix, {kind}) {unit}",
    ),
    ("{a} ({b} to {c} in nine of ten, {kind})", "{a} ({b} à {c} neuf fois sur dix, {kind})"),
    (
        "Computed rocks weigh what they stand for, measured ones all the same; the limit is that of as many computed rocks of equal weight as would know as much.",
        "Les blocs calculés pèsent ce qu’ils représentent, les mesurés tous autant\u{a0}; la limite est celle d’autant de blocs calculés de même poids qu’il en faudrait pour en savoir autant.",
    ),
    (
        "Each measured end is compared with the computed rocks from its own place of release: those of a place weigh as much together as the ends measured there.",
        "Chaque arrêt mesuré est comparé aux blocs calculés depuis son propre lieu de départ\u{a0}: ceux d’un lieu pèsent ensemble autant que les arrêts qui y ont été mesurés.",
    ),
    // Of rocks that weigh what they stand for
    (
        "{share} of the rocks by frequency ({n} of {of} computed)",
        "{share} des blocs selon leur fréquence ({n} sur {of} calculés)",
    ),
    (
        "Conditional on release: reach probability {reach} ({interval}) by frequency; of {releases} computed rocks {count} cross it, {again} more than once. Values at the first crossing.",
        "Conditionnel au départ\u{a0}: probabilité d’atteinte {reach} ({interval}) selon la fréquence\u{a0}; sur {releases} blocs calculés, {count} la franchissent, {again} plusieurs fois. Valeurs au premier passage.",
    ),
    (
        "Conditional on release: reach probability {reach} ({interval}) by frequency; of {releases} computed rocks {count} hit it. Values at the first touch.",
        "Conditionnel au départ\u{a0}: probabilité d’atteinte {reach} ({interval}) selon la fréquence\u{a0}; sur {releases} blocs calculés, {count} le touchent. Valeurs au premier contact.",
    ),
    (
        "None of {n} computed rocks crosses {what} {name}: by frequency its reach probability is below {share} (95\u{2009}% confidence).",
        "Aucun des {n} blocs calculés ne franchit {what} {name}\u{a0}: selon la fréquence sa probabilité d’atteinte est inférieure à {share} (confiance 95\u{2009}%).",
    ),
    ("{what} (computed)", "{what} (calculés)"),
    ("{n} computed", "{n} calculés"),
    (
        "Shares are by frequency; numbers of rocks are of computed ones.",
        "Les parts suivent la fréquence\u{a0}; les nombres de blocs sont ceux des blocs calculés.",
    ),
    (
        "Curves, lines and bars are by frequency; numbers of rocks are of computed ones.",
        "Courbes, traits et barres suivent la fréquence\u{a0}; les nombres de blocs sont ceux des blocs calculés.",
    ),
    (
        "fastest {v} m/s; {share} of the rocks by frequency ({n} of {of} computed) above {limit} m/s, which single blocks seldom pass",
        "le plus rapide {v} m/s\u{a0}; {share} des blocs selon leur fréquence ({n} sur {of} calculés) au-dessus de {limit} m/s, que des blocs isolés dépassent rarement",
    ),
    (
        "{share} of the rocks at rest by frequency ({n} of {of} computed) lie in hollows of the mesh without an outlet, deeper than {depth} m; half of all computed ones lie on {half} of the {all} m² that hold them all",
        "{share} des blocs arrêtés selon leur fréquence ({n} sur {of} calculés) gisent dans des creux du maillage sans exutoire, de plus de {depth} m\u{a0}; la moitié des blocs calculés gît sur {half} des {all} m² qui les contiennent tous",
    ),
    (
        "median edge of the triangles {edge} m, {times} times the diameter of the median rock by frequency ({diameter} m)",
        "arête médiane des triangles {edge} m, {times} fois le diamètre du bloc médian selon la fréquence ({diameter} m)",
    ),
    (
        "calibrated on measured ends ([calibrate] fitted of the scene)",
        "calées sur des arrêts mesurés ([calibrate] fitted de la scène)",
    ),
    (
        "written in the scene; measured ends ([calibrate]) stand beside it and are not fitted",
        "écrites dans la scène\u{a0}; des arrêts mesurés ([calibrate]) figurent à côté, rien n’est calé sur eux",
    ),
    (
        "whether the computed ends are distributed like the measured ones cannot be told: {n} of {of} computed rocks had not ended, and the KS distance is anything from {low} to {high}, 5 % limit {limit}. Give a longer [solver] longest_s or terrain that reaches farther",
        "On ne peut dire si les arrêts calculés sont distribués comme les arrêts mesurés\u{a0}: {n} blocs calculés sur {of} n’étaient pas arrivés, et la distance KS est quelque part entre {low} et {high}, limite à 5 % {limit}. Donner un [solver] longest_s plus long ou un terrain plus étendu",
    ),
    (
        "the computed ends are not distributed like the measured ones: KS distance {ks}, 5 % limit {limit}. The ground values do not hold for this slope",
        "Les arrêts calculés ne sont pas distribués comme les arrêts mesurés\u{a0}: distance KS {ks}, limite à 5 % {limit}. Les valeurs des sols ne sont pas valables pour ce versant",
    ),
    (
        "the weights of {file} are not used: every class of size and source gets the same number of rocks, and each rock stands for its part of the frequency of its zone",
        "Les poids de {file} ne sont pas utilisés\u{a0}: chaque classe de taille de chaque source reçoit autant de blocs, et chaque bloc représente sa part de la fréquence de sa zone",
    ),
    (
        "written in the scene; [report] ground_source names no source",
        "écrites dans la scène\u{a0}; [report] ground_source ne nomme pas de source",
    ),
    (
        "{n} of {tried} releases tried out lie over the object “{name}” before they move: they hit it at once, with the energy of the release. Draw the object or the release elsewhere",
        "{n} départs sur {tried} essayés se trouvent au-dessus de l’objet «\u{a0}{name}\u{a0}» avant tout mouvement\u{a0}: ils l’atteignent aussitôt, avec l’énergie du départ. Dessiner l’objet ou le départ ailleurs",
    ),
];

/// Texts of the view.
pub(super) const VIEW: &[(&str, &str)] = &[
    // The view
    ("{title}: view in three dimensions", "{title}\u{a0}: vue en trois dimensions"),
    (
        "The slope in three dimensions. Arrow keys turn, W A S D move, plus and minus zoom, space plays.",
        "La pente en trois dimensions. Les flèches tournent, W A S D déplacent, plus et moins agrandissent, espace anime.",
    ),
    ("What is shown", "Ce qui est montré"),
    ("Map", "Carte"),
    ("Mouse, touch and keys", "Souris, doigts et touches"),
    ("Turn", "Tourner"),
    ("drag, one finger, arrow keys", "tirer, un doigt, flèches"),
    ("Move", "Déplacer"),
    (
        "right button or Shift and drag, two fingers, W A S D",
        "bouton droit ou Maj et tirer, deux doigts, W A S D",
    ),
    ("Zoom", "Zoomer"),
    ("wheel, pinch, + and −", "molette, pincer, + et −"),
    ("Ask a rock", "Interroger un bloc"),
    ("click its path, its ball or its end", "cliquer sa trajectoire, sa boule ou son arrêt"),
    ("Play", "Animer"),
    ("space", "espace"),
    ("Views", "Vues"),
    ("H all of it, N north up, T from above", "H tout, N nord en haut, T d’en haut"),
    ("Close", "Fermer"),
    ("North", "Nord"),
    ("Time since release", "Temps depuis le départ"),
    ("Light or dark", "Clair ou sombre"),
    ("paths", "trajectoires"),
    ("rocks", "blocs"),
    ("ends", "arrêts"),
    ("trees", "arbres"),
    ("lines, nets", "lignes, filets"),
    ("contours", "courbes de niveau"),
    ("none", "aucune"),
    ("Total energy on the way", "Énergie totale en chemin"),
    ("below {x}", "sous {x}"),
    ("{low} to {high}", "{low} à {high}"),
    ("{x} and more", "{x} et plus"),
    ("Ends", "Arrêts"),
    ("Lines and barriers", "Lignes et ouvrages"),
    ("line or object", "ligne ou objet"),
    ("barrier, at its height", "ouvrage, à sa hauteur"),
    ("Contours every {x} m.", "Courbes de niveau tous les {x} m."),
    ("Rock {n}", "Bloc {n}"),
    ("Radius", "Rayon"),
    ("Mass", "Masse"),
    ("Ended", "Fin"),
    ("Runout", "Distance de propagation"),
    ("Reach angle", "Angle d’énergie"),
    ("Largest speed", "Vitesse maximale"),
    ("Largest total energy", "Énergie totale maximale"),
    ("Largest bounce height", "Hauteur de rebond maximale"),
    ("Impacts", "Impacts"),
    ("{n}, {trees} on trees", "{n}, dont {trees} sur des arbres"),
    ("At {t} s", "À {t} s"),
    ("Height of its centre", "Altitude du centre"),
    (
        "index {n} in releases.csv; “rockfall run SCENE --only {n}” follows it again.",
        "index {n} dans releases.csv\u{a0}; «\u{a0}rockfall run SCENE --only {n}\u{a0}» le suit de nouveau.",
    ),
    ("at rest", "au repos"),
    ("left the terrain", "sorti du terrain"),
    ("time up", "temps écoulé"),
    ("work spent", "budget épuisé"),
    ("failed", "échoué"),
    ("not released", "non parti"),
    (
        "This page cannot be drawn here: {why}. It needs WebGL 2 and a browser of 2023 or newer.",
        "Cette page ne peut être dessinée ici\u{a0}: {why}. Il lui faut WebGL 2 et un navigateur de 2023 ou plus récent.",
    ),
    ("there is no WebGL 2", "il n’y a pas de WebGL 2"),
    ("there is no DecompressionStream", "il n’y a pas de DecompressionStream"),
    (
        "the graphics card was lost; load the page again",
        "la carte graphique a été perdue\u{a0}; recharger la page",
    ),
    ("Reach probability", "Probabilité d’atteinte"),
    ("Total energy, 95 %", "Énergie totale, 95 %"),
    ("Bounce height, 95 %", "Hauteur de rebond, 95 %"),
    ("Deposits in a cell", "Dépôts dans une maille"),
    (
        "Blocks are shown as balls of their volume.",
        "Les blocs qui ont une forme sont montrés en boules de leur volume.",
    ),
    ("Shown are the first {a} of {b} rocks.", "Sont montrés les {a} premiers blocs sur {b}."),
    (
        "Map layers in cells of {x} m, each with its largest value.",
        "Couches en mailles de {x} m, chacune avec sa plus grande valeur.",
    ),
    (
        "Of the paths one in {a} points is drawn, {b} in all.",
        "Des trajectoires un point sur {a} est dessiné, {b} en tout.",
    ),
    (
        "Ground drawn with {a} of {b} triangles; no point of it moved by more than {x} m. The rocks fell on all.",
        "Terrain dessiné avec {a} triangles sur {b}\u{a0}; aucun point n’est déplacé de plus de {x} m. Les blocs sont tombés sur tous.",
    ),
    (
        "Of the trees one in {a} is drawn. The rocks fell among all.",
        "Des arbres un sur {a} est dessiné. Les blocs sont tombés parmi tous.",
    ),
    ("{a} of {b} rocks cross", "{a} blocs sur {b} passent"),
    (
        "{h} m, {e} kJ: stops {a} of the {b} that arrive",
        "{h} m, {e} kJ\u{a0}: arrête {a} des {b} qui arrivent",
    ),
    ("{share} of the rocks by frequency cross", "{share} des blocs passent, selon leur fréquence"),
    (
        "{h} m, {e} kJ: stops {share} of those that arrive, by frequency",
        "{h} m, {e} kJ\u{a0}: arrête {share} de ceux qui arrivent, selon leur fréquence",
    ),
];
