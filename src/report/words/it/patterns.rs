//! What the program records in English but the plan, and texts of the view, in Italian.

/// What the program records but the plan, by patterns.
pub(super) const RECORDED: &[(&str, &str)] = &[
    // What it warns of
    (
        "{where} omega * step_s = {x} for a rock of {r} m, which does not resolve its impacts: write a step_s below {y}",
        "{where} omega * step_s = {x} per un masso di {r} m, che non risolve i suoi urti: scrivere uno step_s sotto {y}",
    ),
    (
        "{where} normal_stiffness_n_m = {k} lets a rock of {r} m sink in by more than 0.1 of its radius in impacts above {v} m/s; {need} would hold it up to {most} m/s",
        "{where} normal_stiffness_n_m = {k} lascia affondare un masso di {r} m di oltre 0.1 del suo raggio negli urti sopra {v} m/s; {need} lo terrebbe fino a {most} m/s",
    ),
    (
        "{where} normal_stiffness_n_m = {k} lets a rock of {r} m sink in by more than 0.3 of its corners' radius in impacts above {v} m/s; {need} would hold it up to {most} m/s",
        "{where} normal_stiffness_n_m = {k} lascia affondare un masso di {r} m di oltre 0.3 del raggio dei suoi spigoli negli urti sopra {v} m/s; {need} lo terrebbe fino a {most} m/s",
    ),
    (
        "{file} says how often its zones release rocks, and the scene asks for nothing a year: write the table [frequency], and each zone is a source",
        "{file} dice quanto spesso le sue zone liberano massi, e la scena non chiede nulla all’anno: scrivere la tabella [frequency], e ogni zona è una sorgente",
    ),
    (
        "sizes are sampled by importance: large rocks are computed more often than they come. Percentiles, shares and maps are weighted back and hold for the sources as they are; counts of rocks and dots in figures show rocks as computed",
        "le dimensioni sono estratte per importanza: i massi grandi sono calcolati più spesso di quanto vengano. Percentili, percentuali e mappe sono ripesati e valgono per le sorgenti come sono; conteggi e punti nelle figure mostrano i massi come calcolati",
    ),
    (
        "{a} of {b} rocks failed: they count as far as they came; `--only {c}` shows one again",
        "{a} massi su {b} sono falliti: contano fin dove sono giunti; `--only {c}` ne mostra uno di nuovo",
    ),
    (
        "source “{a}”: no rock of {b} of its {c} events a year was released: they are missing in every number",
        "sorgente “{a}”: per {b} dei suoi {c} eventi all’anno nessun masso è partito: mancano in ogni numero",
    ),
    (
        "{a} of {b} rocks were not released, {why}: they are counted, but in no statistic; the first is release {c}",
        "{a} massi su {b} non si sono staccati, {why}: contati, ma in nessuna statistica; il primo è il distacco {c}",
    ),
    (
        "{a} of {b} rocks were still moving when their budget of work was spent: they count as far as they came; `--only {c}` shows one again",
        "{a} massi su {b} si muovevano ancora quando il loro budget di calcolo era esaurito: contano fin dove sono giunti; `--only {c}` ne mostra uno di nuovo",
    ),
    (
        "barrier “{name}”: {a} of {b} arriving rocks cross it where the terrain has a hole: their height is not known, and they count as passing over it; fill the hole",
        "barriera “{name}”: {a} dei {b} massi che arrivano la attraversano dove il terreno ha un buco: la loro altezza non è nota e contano come passati sopra; riempire il buco",
    ),
    (
        "{a} of {b} contact steps did not settle: their contact forces do not agree with their motion; take a smaller tolerance_m_s, step_s or corner_way, whichever the scheme has",
        "{a} passi di contatto su {b} non si sono assestati: le loro forze non concordano con il moto; prendere tolerance_m_s, step_s o corner_way più piccolo, secondo lo schema",
    ),
    (
        "the computation itself lost {x} % of the energy released, beside friction and damping; take a smaller tolerance or step, or scheme \"reference\"",
        "il calcolo stesso ha perso {x} % dell’energia liberata, oltre ad attrito e smorzamento; prendere una tolleranza o un passo più piccolo, o lo schema \"reference\"",
    ),
    (
        "the computation itself gained {x} % of the energy released, beside friction and damping; take a smaller tolerance or step, or scheme \"reference\"",
        "il calcolo stesso ha guadagnato {x} % dell’energia liberata, oltre ad attrito e smorzamento; prendere una tolleranza o un passo più piccolo, o lo schema \"reference\"",
    ),
    (
        "release {a}: its mechanical energy rose by {x} J in one contact; take a smaller tolerance or step",
        "distacco {a}: la sua energia meccanica è salita di {x} J in un contatto; prendere una tolleranza o un passo più piccolo",
    ),
    // What went in
    ("Rock density", "Densità dei massi"),
    ("Rock radius", "Raggio dei massi"),
    ("Release above the ground", "Distacco sopra il suolo"),
    ("Velocity at release (x | y | z)", "Velocità al distacco (x | y | z)"),
    ("Spin at release (x | y | z)", "Rotazione al distacco (x | y | z)"),
    ("Ground “{name}”", "Suolo «{name}»"),
    ("Trees “{name}”", "Alberi «{name}»"),
    ("Source “{name}”", "Sorgente «{name}»"),
    ("Object “{name}”", "Oggetto «{name}»"),
    ("by the volumes of the sources, see below", "secondo i volumi delle sorgenti, vedi sotto"),
    ("springs {a} normal, {b} along the surface", "molle {a} normali, {b} lungo la superficie"),
    ("{a} times that", "{a} volte tanto"),
    ("friction angle {a}", "angolo d’attrito {a}"),
    ("restitution {a}", "restituzione {a}"),
    ("rolling friction {a}", "attrito volvente {a}"),
    ("roughness length {a}", "lunghezza di rugosità {a}"),
    ("roughness {a}", "rugosità {a}"),
    ("gives way above {a}", "cede sopra {a}"),
    (
        "friction grows with slip to {a}, κ {b} 1/m, forgotten with {c} 1/s",
        "l’attrito cresce con lo scivolamento fino a {a}, κ {b} 1/m, dimenticato con {c} 1/s",
    ),
    (
        "soil of {a} kN/m² and {b} kg/m³, drags with C = {c}",
        "terreno di {a} kN/m² e {b} kg/m³, frena con C = {c}",
    ),
    ("half of the restitution is left at {a}", "metà della restituzione resta a {a}"),
    (
        "{a} ({b} to {c} in nine of ten, {kind}) {unit}",
        "{a} (da {b} a {c} in nove casi su dieci, {kind}) {unit}",
    ),
    ("{a} ({b} to {c} in nine of ten, {kind})", "{a} (da {b} a {c} in nove casi su dieci, {kind})"),
    (
        "Computed rocks weigh what they stand for, measured ones all the same; the limit is that of as many computed rocks of equal weight as would know as much.",
        "I massi calcolati pesano ciò che rappresentano, quelli misurati tutti uguale; il limite è quello di tanti massi calcolati di ugual peso quanti ne saprebbero altrettanto.",
    ),
    (
        "Each measured end is compared with the computed rocks from its own place of release: those of a place weigh as much together as the ends measured there.",
        "Ogni arresto misurato è confrontato con i massi calcolati dal proprio luogo di partenza: quelli di un luogo pesano insieme quanto gli arresti lì misurati.",
    ),
    // Of rocks that weigh what they stand for
    (
        "{share} of the rocks by frequency ({n} of {of} computed)",
        "{share} dei massi secondo la frequenza ({n} su {of} calcolati)",
    ),
    (
        "Conditional on release: reach probability {reach} ({interval}) by frequency; of {releases} computed rocks {count} cross it, {again} more than once. Values at the first crossing.",
        "Condizionato al distacco: probabilità di raggiungimento {reach} ({interval}) secondo la frequenza; di {releases} massi calcolati {count} la attraversano, {again} più volte. Valori al primo passaggio.",
    ),
    (
        "Conditional on release: reach probability {reach} ({interval}) by frequency; of {releases} computed rocks {count} hit it. Values at the first touch.",
        "Condizionato al distacco: probabilità di raggiungimento {reach} ({interval}) secondo la frequenza; di {releases} massi calcolati {count} lo colpiscono. Valori al primo contatto.",
    ),
    (
        "None of {n} computed rocks crosses {what} {name}: by frequency its reach probability is below {share} (95\u{2009}% confidence).",
        "Nessuno dei {n} massi calcolati attraversa {what} {name}: secondo la frequenza la probabilità di raggiungimento è sotto {share} (confidenza 95\u{2009}%).",
    ),
    ("{what} (computed)", "{what} (calcolati)"),
    ("{n} computed", "{n} calcolati"),
    (
        "Shares are by frequency; numbers of rocks are of computed ones.",
        "Le percentuali seguono la frequenza; i numeri di massi sono quelli dei massi calcolati.",
    ),
    (
        "Curves, lines and bars are by frequency; numbers of rocks are of computed ones.",
        "Curve, linee e barre seguono la frequenza; i numeri di massi sono quelli dei massi calcolati.",
    ),
    (
        "fastest {v} m/s; {share} of the rocks by frequency ({n} of {of} computed) above {limit} m/s, which single blocks seldom pass",
        "il più veloce {v} m/s; {share} dei massi secondo la frequenza ({n} su {of} calcolati) oltre {limit} m/s, che singoli massi raramente superano",
    ),
    (
        "{share} of the rocks at rest by frequency ({n} of {of} computed) lie in hollows of the mesh without an outlet, deeper than {depth} m; half of all computed ones lie on {half} of the {all} m² that hold them all",
        "{share} dei massi fermi secondo la frequenza ({n} su {of} calcolati) giacciono in conche della maglia senza sbocco, più profonde di {depth} m; la metà dei massi calcolati giace su {half} dei {all} m² che li contengono tutti",
    ),
    (
        "median edge of the triangles {edge} m, {times} times the diameter of the median rock by frequency ({diameter} m)",
        "spigolo mediano dei triangoli {edge} m, {times} volte il diametro del masso mediano secondo la frequenza ({diameter} m)",
    ),
    (
        "calibrated on measured ends ([calibrate] fitted of the scene)",
        "calibrati su arresti misurati ([calibrate] fitted della scena)",
    ),
    (
        "written in the scene; measured ends ([calibrate]) stand beside it and are not fitted",
        "scritti nella scena; gli arresti misurati ([calibrate]) vi stanno accanto, nulla è calibrato su di essi",
    ),
    (
        "whether the computed ends are distributed like the measured ones cannot be told: {n} of {of} computed rocks had not ended, and the KS distance is anything from {low} to {high}, 5 % limit {limit}. Give a longer [solver] longest_s or terrain that reaches farther",
        "Non si può dire se gli arresti calcolati siano distribuiti come quelli misurati: {n} massi calcolati su {of} non erano giunti alla fine, e la distanza KS è tra {low} e {high}, limite al 5 % {limit}. Dare un [solver] longest_s più lungo o un terreno più esteso",
    ),
    (
        "the computed ends are not distributed like the measured ones: KS distance {ks}, 5 % limit {limit}. The ground values do not hold for this slope",
        "Gli arresti calcolati non sono distribuiti come quelli misurati: distanza KS {ks}, limite al 5 % {limit}. I valori del terreno non valgono per questo versante",
    ),
    (
        "the weights of {file} are not used: every class of size and source gets the same number of rocks, and each rock stands for its part of the frequency of its zone",
        "I pesi di {file} non sono usati: ogni classe di dimensione di ogni sorgente riceve lo stesso numero di massi, e ogni masso rappresenta la sua parte della frequenza della sua zona",
    ),
    (
        "written in the scene; [report] ground_source names no source",
        "scritti nella scena; [report] ground_source non nomina alcuna fonte",
    ),
    (
        "{n} of {tried} releases tried out lie over the object “{name}” before they move: they hit it at once, with the energy of the release. Draw the object or the release elsewhere",
        "{n} distacchi su {tried} provati si trovano sopra l’oggetto «{name}» prima di ogni movimento: lo colpiscono subito, con l’energia del distacco. Disegnare altrove l’oggetto o il distacco",
    ),
];

/// Texts of the view.
pub(super) const VIEW: &[(&str, &str)] = &[
    // The view
    ("{title}: view in three dimensions", "{title}: vista in tre dimensioni"),
    (
        "The slope in three dimensions. Arrow keys turn, W A S D move, plus and minus zoom, space plays.",
        "Il pendio in tre dimensioni. Le frecce girano, W A S D spostano, più e meno ingrandiscono, spazio avvia.",
    ),
    ("What is shown", "Che cosa si vede"),
    ("Map", "Mappa"),
    ("Mouse, touch and keys", "Mouse, dita e tasti"),
    ("Turn", "Girare"),
    ("drag, one finger, arrow keys", "trascinare, un dito, frecce"),
    ("Move", "Spostare"),
    (
        "right button or Shift and drag, two fingers, W A S D",
        "tasto destro o Maiusc e trascinare, due dita, W A S D",
    ),
    ("Zoom", "Ingrandire"),
    ("wheel, pinch, + and −", "rotella, pizzico, + e −"),
    ("Ask a rock", "Interrogare un masso"),
    ("click its path, its ball or its end", "clic su traiettoria, sfera o arresto"),
    ("Play", "Avviare"),
    ("space", "spazio"),
    ("Views", "Viste"),
    ("H all of it, N north up, T from above", "H tutto, N nord in alto, T dall’alto"),
    ("Close", "Chiudere"),
    ("North", "Nord"),
    ("Time since release", "Tempo dal distacco"),
    ("Light or dark", "Chiaro o scuro"),
    ("paths", "traiettorie"),
    ("rocks", "massi"),
    ("ends", "arresti"),
    ("trees", "alberi"),
    ("lines, nets", "linee, reti"),
    ("contours", "curve di livello"),
    ("none", "nessuna"),
    ("Total energy on the way", "Energia totale lungo il percorso"),
    ("below {x}", "sotto {x}"),
    ("{low} to {high}", "da {low} a {high}"),
    ("{x} and more", "{x} e più"),
    ("Ends", "Arresti"),
    ("Lines and barriers", "Linee e barriere"),
    ("line or object", "linea o oggetto"),
    ("barrier, at its height", "barriera, alla sua altezza"),
    ("Contours every {x} m.", "Curve di livello ogni {x} m."),
    ("Rock {n}", "Masso {n}"),
    ("Radius", "Raggio"),
    ("Mass", "Massa"),
    ("Ended", "Fine"),
    ("Runout", "Distanza di arresto"),
    ("Reach angle", "Angolo di propagazione"),
    ("Largest speed", "Velocità massima"),
    ("Largest total energy", "Energia totale massima"),
    ("Largest bounce height", "Altezza di rimbalzo massima"),
    ("Impacts", "Impatti"),
    ("{n}, {trees} on trees", "{n}, di cui {trees} su alberi"),
    ("At {t} s", "A {t} s"),
    ("Height of its centre", "Quota del centro"),
    (
        "index {n} in releases.csv; “rockfall run SCENE --only {n}” follows it again.",
        "index {n} in releases.csv; «rockfall run SCENE --only {n}» lo segue di nuovo.",
    ),
    ("at rest", "a riposo"),
    ("left the terrain", "uscito dal terreno"),
    ("time up", "tempo scaduto"),
    ("work spent", "budget esaurito"),
    ("failed", "fallito"),
    ("not released", "non staccato"),
    (
        "This page cannot be drawn here: {why}. It needs WebGL 2 and a browser of 2023 or newer.",
        "Questa pagina non può essere disegnata qui: {why}. Le servono WebGL 2 e un browser del 2023 o più recente.",
    ),
    ("there is no WebGL 2", "non c’è WebGL 2"),
    ("there is no DecompressionStream", "non c’è DecompressionStream"),
    (
        "the graphics card was lost; load the page again",
        "la scheda grafica è andata persa; ricaricare la pagina",
    ),
    ("Reach probability", "Probabilità di raggiungimento"),
    ("Total energy, 95 %", "Energia totale, 95 %"),
    ("Bounce height, 95 %", "Altezza di rimbalzo, 95 %"),
    ("Deposits in a cell", "Depositi in una cella"),
    (
        "Blocks are shown as balls of their volume.",
        "I blocchi che hanno una forma sono mostrati come sfere del loro volume.",
    ),
    ("Shown are the first {a} of {b} rocks.", "Si vedono i primi {a} massi su {b}."),
    (
        "Map layers in cells of {x} m, each with its largest value.",
        "Strati in celle di {x} m, ciascuna con il suo valore massimo.",
    ),
    (
        "Of the paths one in {a} points is drawn, {b} in all.",
        "Delle traiettorie è disegnato un punto su {a}, {b} in tutto.",
    ),
    (
        "Ground drawn with {a} of {b} triangles; no point of it moved by more than {x} m. The rocks fell on all.",
        "Terreno disegnato con {a} triangoli su {b}; nessun punto è spostato di più di {x} m. I massi sono caduti su tutti.",
    ),
    (
        "Of the trees one in {a} is drawn. The rocks fell among all.",
        "Degli alberi è disegnato uno su {a}. I massi sono caduti tra tutti.",
    ),
    ("{a} of {b} rocks cross", "passano {a} massi su {b}"),
    (
        "{h} m, {e} kJ: stops {a} of the {b} that arrive",
        "{h} m, {e} kJ: ferma {a} dei {b} che arrivano",
    ),
    ("{share} of the rocks by frequency cross", "passa il {share} dei massi secondo la frequenza"),
    (
        "{h} m, {e} kJ: stops {share} of those that arrive, by frequency",
        "{h} m, {e} kJ: ferma il {share} di quelli che arrivano, secondo la frequenza",
    ),
];
