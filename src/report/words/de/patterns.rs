//! What the program records in English but the plan, and texts of the view, in German.

/// What the program records but the plan, by patterns.
pub(super) const RECORDED: &[(&str, &str)] = &[
    // What it warns of
    (
        "{where} omega * step_s = {x} for a rock of {r} m, which does not resolve its impacts: write a step_s below {y}",
        "{where} omega * step_s = {x} für einen Block von {r} m, was seine Aufpralle nicht auflöst: step_s kleiner als {y} schreiben",
    ),
    (
        "{where} normal_stiffness_n_m = {k} lets a rock of {r} m sink in by more than 0.1 of its radius in impacts above {v} m/s; {need} would hold it up to {most} m/s",
        "{where} normal_stiffness_n_m = {k} lässt einen Block von {r} m bei Aufprallen über {v} m/s um mehr als 0.1 seines Radius einsinken; {need} hielte ihn bis {most} m/s",
    ),
    (
        "{where} normal_stiffness_n_m = {k} lets a rock of {r} m sink in by more than 0.3 of its corners' radius in impacts above {v} m/s; {need} would hold it up to {most} m/s",
        "{where} normal_stiffness_n_m = {k} lässt einen Block von {r} m bei Aufprallen über {v} m/s um mehr als 0.3 des Radius seiner Ecken einsinken; {need} hielte ihn bis {most} m/s",
    ),
    (
        "{file} says how often its zones release rocks, and the scene asks for nothing a year: write the table [frequency], and each zone is a source",
        "{file} sagt, wie oft seine Zonen Blöcke ablösen, und die Szene fragt nichts pro Jahr: die Tabelle [frequency] schreiben, und jede Zone ist eine Quelle",
    ),
    (
        "sizes are sampled by importance: large rocks are computed more often than they come. Percentiles, shares and maps are weighted back and hold for the sources as they are; counts of rocks and dots in figures show rocks as computed",
        "Größen sind nach Wichtigkeit gezogen: große Blöcke werden häufiger gerechnet, als sie kommen. Perzentile, Anteile und Karten sind zurückgewichtet und gelten für die Quellen, wie sie sind; Anzahlen und Punkte in Abbildungen zeigen Blöcke wie gerechnet",
    ),
    (
        "{a} of {b} rocks failed: they count as far as they came; `--only {c}` shows one again",
        "{a} von {b} Blöcken sind fehlgeschlagen: sie zählen, so weit sie kamen; `--only {c}` zeigt einen noch einmal",
    ),
    (
        "source “{a}”: no rock of {b} of its {c} events a year was released: they are missing in every number",
        "Quelle “{a}”: von {b} ihrer {c} Ereignisse im Jahr wurde kein Block abgelöst: sie fehlen in jeder Zahl",
    ),
    (
        "{a} of {b} rocks were not released, {why}: they are counted, but in no statistic; the first is release {c}",
        "{a} von {b} Blöcken wurden nicht abgelöst, {why}: gezählt, aber in keiner Statistik; der erste ist Ablösung {c}",
    ),
    (
        "{a} of {b} rocks were still moving when their budget of work was spent: they count as far as they came; `--only {c}` shows one again",
        "{a} von {b} Blöcken bewegten sich noch, als ihr Rechenbudget erschöpft war: sie zählen, so weit sie kamen; `--only {c}` zeigt einen noch einmal",
    ),
    (
        "barrier “{name}”: {a} of {b} arriving rocks cross it where the terrain has a hole: their height is not known, and they count as passing over it; fill the hole",
        "Schutzbauwerk “{name}”: {a} von {b} ankommenden Blöcken queren es, wo das Gelände ein Loch hat: ihre Höhe ist unbekannt, sie zählen als darüber hinweg; das Loch füllen",
    ),
    (
        "{a} of {b} contact steps did not settle: their contact forces do not agree with their motion; take a smaller tolerance_m_s, step_s or corner_way, whichever the scheme has",
        "{a} von {b} Kontaktschritten kamen nicht zur Ruhe: ihre Kontaktkräfte passen nicht zu ihrer Bewegung; kleineres tolerance_m_s, step_s oder corner_way nehmen, je nach Verfahren",
    ),
    (
        "the computation itself lost {x} % of the energy released, beside friction and damping; take a smaller tolerance or step, or scheme \"reference\"",
        "die Rechnung selbst verlor {x} % der freigesetzten Energie, neben Reibung und Dämpfung; kleinere Toleranz oder kleineren Schritt nehmen, oder das Verfahren \"reference\"",
    ),
    (
        "the computation itself gained {x} % of the energy released, beside friction and damping; take a smaller tolerance or step, or scheme \"reference\"",
        "die Rechnung selbst gewann {x} % der freigesetzten Energie, neben Reibung und Dämpfung; kleinere Toleranz oder kleineren Schritt nehmen, oder das Verfahren \"reference\"",
    ),
    (
        "release {a}: its mechanical energy rose by {x} J in one contact; take a smaller tolerance or step",
        "Ablösung {a}: ihre mechanische Energie stieg in einem Kontakt um {x} J; kleinere Toleranz oder kleineren Schritt nehmen",
    ),
    // What went in
    ("Rock density", "Dichte der Blöcke"),
    ("Rock radius", "Radius der Blöcke"),
    ("Release above the ground", "Ablösung über dem Boden"),
    ("Velocity at release (x | y | z)", "Geschwindigkeit bei der Ablösung (x | y | z)"),
    ("Spin at release (x | y | z)", "Drehgeschwindigkeit bei der Ablösung (x | y | z)"),
    ("Ground “{name}”", "Boden „{name}“"),
    ("Trees “{name}”", "Bäume „{name}“"),
    ("Source “{name}”", "Quelle „{name}“"),
    ("Object “{name}”", "Objekt „{name}“"),
    ("by the volumes of the sources, see below", "nach den Volumen der Quellen, siehe unten"),
    ("springs {a} normal, {b} along the surface", "Federn {a} normal, {b} entlang der Oberfläche"),
    ("{a} times that", "das {a}-Fache davon"),
    ("friction angle {a}", "Reibungswinkel {a}"),
    ("restitution {a}", "Rückprall {a}"),
    ("rolling friction {a}", "Rollreibung {a}"),
    ("roughness length {a}", "Rauheitslänge {a}"),
    ("roughness {a}", "Rauheit {a}"),
    ("gives way above {a}", "gibt nach über {a}"),
    (
        "friction grows with slip to {a}, κ {b} 1/m, forgotten with {c} 1/s",
        "Reibung wächst mit dem Gleitweg bis {a}, κ {b} 1/m, vergessen mit {c} 1/s",
    ),
    (
        "soil of {a} kN/m² and {b} kg/m³, drags with C = {c}",
        "Erdreich von {a} kN/m² und {b} kg/m³, bremst mit C = {c}",
    ),
    ("half of the restitution is left at {a}", "die Hälfte des Rückpralls bleibt bei {a}"),
    (
        "{a} ({b} to {c} in nine of ten, {kind}) {unit}",
        "{a} ({b} bis {c} in neun von zehn, {kind}) {unit}",
    ),
    ("{a} ({b} to {c} in nine of ten, {kind})", "{a} ({b} bis {c} in neun von zehn, {kind})"),
    (
        "Computed rocks weigh what they stand for, measured ones all the same; the limit is that of as many computed rocks of equal weight as would know as much.",
        "Gerechnete Blöcke wiegen, wofür sie stehen, gemessene alle gleich viel; die Grenze ist die von so vielen gerechneten Blöcken gleichen Gewichts, wie gleich viel wüssten.",
    ),
    (
        "Each measured end is compared with the computed rocks from its own place of release: those of a place weigh as much together as the ends measured there.",
        "Jeder gemessene Endpunkt ist mit den gerechneten Blöcken von seinem eigenen Abgangsort verglichen: jene eines Ortes wiegen zusammen so viel wie die dort gemessenen Endpunkte.",
    ),
    // Of rocks that weigh what they stand for
    (
        "{share} of the rocks by frequency ({n} of {of} computed)",
        "{share} der Blöcke nach Häufigkeit ({n} von {of} gerechneten)",
    ),
    (
        "Conditional on release: reach probability {reach} ({interval}) by frequency; of {releases} computed rocks {count} cross it, {again} more than once. Values at the first crossing.",
        "Bedingt auf die Ablösung: Erreichenswahrscheinlichkeit {reach} ({interval}) nach Häufigkeit; von {releases} gerechneten Blöcken überqueren {count} sie, {again} mehrmals. Werte beim ersten Durchgang.",
    ),
    (
        "Conditional on release: reach probability {reach} ({interval}) by frequency; of {releases} computed rocks {count} hit it. Values at the first touch.",
        "Bedingt auf die Ablösung: Erreichenswahrscheinlichkeit {reach} ({interval}) nach Häufigkeit; von {releases} gerechneten Blöcken treffen es {count}. Werte bei der ersten Berührung.",
    ),
    (
        "None of {n} computed rocks crosses {what} {name}: by frequency its reach probability is below {share} (95\u{2009}% confidence).",
        "Keiner von {n} gerechneten Blöcken überquert {what} {name}: nach Häufigkeit liegt die Erreichenswahrscheinlichkeit unter {share} (Vertrauen 95\u{2009}%).",
    ),
    ("{what} (computed)", "{what} (gerechnet)"),
    ("{n} computed", "{n} gerechnet"),
    (
        "Shares are by frequency; numbers of rocks are of computed ones.",
        "Anteile gelten nach Häufigkeit; Anzahlen sind die der gerechneten Blöcke.",
    ),
    (
        "Curves, lines and bars are by frequency; numbers of rocks are of computed ones.",
        "Kurven, Linien und Balken gelten nach Häufigkeit; Anzahlen sind die der gerechneten Blöcke.",
    ),
    (
        "fastest {v} m/s; {share} of the rocks by frequency ({n} of {of} computed) above {limit} m/s, which single blocks seldom pass",
        "schnellster {v} m/s; {share} der Blöcke nach Häufigkeit ({n} von {of} gerechneten) über {limit} m/s, was Einzelblöcke selten überschreiten",
    ),
    (
        "{share} of the rocks at rest by frequency ({n} of {of} computed) lie in hollows of the mesh without an outlet, deeper than {depth} m; half of all computed ones lie on {half} of the {all} m² that hold them all",
        "{share} der ruhenden Blöcke nach Häufigkeit ({n} von {of} gerechneten) liegen in abflusslosen Mulden des Dreiecksnetzes, tiefer als {depth} m; die Hälfte aller gerechneten liegt auf {half} der {all} m², die alle aufnehmen",
    ),
    (
        "median edge of the triangles {edge} m, {times} times the diameter of the median rock by frequency ({diameter} m)",
        "Median der Kantenlängen der Dreiecke {edge} m, das {times}-Fache des nach Häufigkeit gewichteten Median-Durchmessers der Blöcke ({diameter} m)",
    ),
    (
        "calibrated on measured ends ([calibrate] fitted of the scene)",
        "an gemessenen Endpunkten kalibriert ([calibrate] fitted der Szene)",
    ),
    (
        "written in the scene; measured ends ([calibrate]) stand beside it and are not fitted",
        "in der Szene geschrieben; gemessene Endpunkte ([calibrate]) stehen daneben, angepasst ist nichts",
    ),
    (
        "whether the computed ends are distributed like the measured ones cannot be told: {n} of {of} computed rocks had not ended, and the KS distance is anything from {low} to {high}, 5 % limit {limit}. Give a longer [solver] longest_s or terrain that reaches farther",
        "Ob die berechneten Endpunkte so verteilt sind wie die gemessenen, ist nicht zu sagen: {n} von {of} berechneten Blöcken waren nicht am Ende, und der KS-Abstand liegt irgendwo zwischen {low} und {high}, 5-%-Schranke {limit}. Ein längeres [solver] longest_s oder weiter reichendes Gelände angeben",
    ),
    (
        "the computed ends are not distributed like the measured ones: KS distance {ks}, 5 % limit {limit}. The ground values do not hold for this slope",
        "Die gerechneten Endpunkte sind nicht verteilt wie die gemessenen: KS-Abstand {ks}, Grenze bei 5 % {limit}. Die Bodenkennwerte gelten für diesen Hang nicht",
    ),
    (
        "the weights of {file} are not used: every class of size and source gets the same number of rocks, and each rock stands for its part of the frequency of its zone",
        "Die Gewichte von {file} werden nicht verwendet: Jede Größenklasse jeder Quelle bekommt gleich viele Blöcke, und jeder Block steht für seinen Teil der Häufigkeit seiner Zone",
    ),
    (
        "written in the scene; [report] ground_source names no source",
        "in der Szene geschrieben; [report] ground_source nennt keine Quelle",
    ),
    (
        "{n} of {tried} releases tried out lie over the object “{name}” before they move: they hit it at once, with the energy of the release. Draw the object or the release elsewhere",
        "{n} von {tried} versuchten Ablösungen liegen schon vor der Bewegung über dem Objekt „{name}“: Sie treffen es sofort, mit der Energie der Ablösung. Objekt oder Ablösung anderswo zeichnen",
    ),
];

/// Texts of the view.
pub(super) const VIEW: &[(&str, &str)] = &[
    // The view
    ("{title}: view in three dimensions", "{title}: Ansicht in drei Dimensionen"),
    (
        "The slope in three dimensions. Arrow keys turn, W A S D move, plus and minus zoom, space plays.",
        "Der Hang in drei Dimensionen. Pfeiltasten drehen, W A S D verschieben, Plus und Minus vergrößern, Leertaste spielt ab.",
    ),
    ("What is shown", "Was gezeigt wird"),
    ("Map", "Karte"),
    ("Mouse, touch and keys", "Maus, Finger und Tasten"),
    ("Turn", "Drehen"),
    ("drag, one finger, arrow keys", "ziehen, ein Finger, Pfeiltasten"),
    ("Move", "Verschieben"),
    (
        "right button or Shift and drag, two fingers, W A S D",
        "rechte Taste oder Umschalt und ziehen, zwei Finger, W A S D",
    ),
    ("Zoom", "Vergrößern"),
    ("wheel, pinch, + and −", "Rad, spreizen, + und −"),
    ("Ask a rock", "Einen Block fragen"),
    ("click its path, its ball or its end", "auf Bahn, Kugel oder Ende klicken"),
    ("Play", "Abspielen"),
    ("space", "Leertaste"),
    ("Views", "Ansichten"),
    ("H all of it, N north up, T from above", "H alles, N Norden oben, T von oben"),
    ("Close", "Schließen"),
    ("North", "Norden"),
    ("Time since release", "Zeit seit der Ablösung"),
    ("Light or dark", "Hell oder dunkel"),
    ("paths", "Bahnen"),
    ("rocks", "Blöcke"),
    ("ends", "Endpunkte"),
    ("trees", "Bäume"),
    ("lines, nets", "Linien, Schutzbauwerke"),
    ("contours", "Höhenlinien"),
    ("none", "keine"),
    ("Total energy on the way", "Gesamtenergie unterwegs"),
    ("below {x}", "unter {x}"),
    ("{low} to {high}", "{low} bis {high}"),
    ("{x} and more", "{x} und mehr"),
    ("Ends", "Endpunkte"),
    ("Lines and barriers", "Linien und Schutzbauwerke"),
    ("line or object", "Linie oder Objekt"),
    ("barrier, at its height", "Schutzbauwerk, in seiner Höhe"),
    ("Contours every {x} m.", "Höhenlinien alle {x} m."),
    ("Rock {n}", "Block {n}"),
    ("Radius", "Radius"),
    ("Mass", "Masse"),
    ("Ended", "Ende"),
    ("Runout", "Auslaufstrecke"),
    ("Reach angle", "Pauschalgefälle"),
    ("Largest speed", "Maximale Geschwindigkeit"),
    ("Largest total energy", "Maximale Gesamtenergie"),
    ("Largest bounce height", "Maximale Sprunghöhe"),
    ("Impacts", "Aufpralle"),
    ("{n}, {trees} on trees", "{n}, davon {trees} an Bäumen"),
    ("At {t} s", "Bei {t} s"),
    ("Height of its centre", "Höhe des Mittelpunkts"),
    (
        "index {n} in releases.csv; “rockfall run SCENE --only {n}” follows it again.",
        "index {n} in releases.csv; „rockfall run SCENE --only {n}“ verfolgt ihn noch einmal.",
    ),
    ("at rest", "in Ruhe"),
    ("left the terrain", "Gelände verlassen"),
    ("time up", "Zeit abgelaufen"),
    ("work spent", "Budget erschöpft"),
    ("failed", "fehlgeschlagen"),
    ("not released", "nicht abgelöst"),
    (
        "This page cannot be drawn here: {why}. It needs WebGL 2 and a browser of 2023 or newer.",
        "Diese Seite kann hier nicht gezeichnet werden: {why}. Sie braucht WebGL 2 und einen Browser von 2023 oder neuer.",
    ),
    ("there is no WebGL 2", "es gibt kein WebGL 2"),
    ("there is no DecompressionStream", "es gibt keinen DecompressionStream"),
    (
        "the graphics card was lost; load the page again",
        "die Grafikkarte ging verloren; Seite neu laden",
    ),
    ("Reach probability", "Erreichenswahrscheinlichkeit"),
    ("Total energy, 95 %", "Gesamtenergie, 95 %"),
    ("Bounce height, 95 %", "Sprunghöhe, 95 %"),
    ("Deposits in a cell", "Ablagerungen in einer Zelle"),
    (
        "Blocks are shown as balls of their volume.",
        "Blöcke mit einer Form sind als Kugeln ihres Volumens gezeigt.",
    ),
    ("Shown are the first {a} of {b} rocks.", "Gezeigt sind die ersten {a} von {b} Blöcken."),
    (
        "Map layers in cells of {x} m, each with its largest value.",
        "Kartenebenen in Zellen von {x} m, jede mit ihrem größten Wert.",
    ),
    (
        "Of the paths one in {a} points is drawn, {b} in all.",
        "Von den Bahnen ist einer von {a} Punkten gezeichnet, {b} insgesamt.",
    ),
    (
        "Ground drawn with {a} of {b} triangles; no point of it moved by more than {x} m. The rocks fell on all.",
        "Gelände mit {a} von {b} Dreiecken gezeichnet; kein Punkt ist um mehr als {x} m verschoben. Die Blöcke fielen auf alle.",
    ),
    (
        "Of the trees one in {a} is drawn. The rocks fell among all.",
        "Von den Bäumen ist einer von {a} gezeichnet. Die Blöcke fielen zwischen allen.",
    ),
    ("{a} of {b} rocks cross", "{a} von {b} Blöcken queren"),
    (
        "{h} m, {e} kJ: stops {a} of the {b} that arrive",
        "{h} m, {e} kJ: hält {a} der {b} auf, die ankommen",
    ),
    ("{share} of the rocks by frequency cross", "{share} der Blöcke nach Häufigkeit queren"),
    (
        "{h} m, {e} kJ: stops {share} of those that arrive, by frequency",
        "{h} m, {e} kJ: hält {share} derer auf, die ankommen, nach Häufigkeit",
    ),
];
