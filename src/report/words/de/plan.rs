//! What the plan says in English, in German.

/// Names of its parts, and what it says of them, by patterns.
pub(super) const PLAN: &[(&str, &str)] = &[
    // Names of the plan's parts
    ("[scene]", "Szene"),
    ("[file]", "Datei"),
    ("[version]", "Version"),
    ("[releases]", "Ablösungen"),
    ("[radius]", "Radius"),
    ("[sizes of table]", "Größen der Tabelle"),
    ("[lifted]", "angehoben"),
    ("[terrain]", "Gelände"),
    ("[input file]", "Eingabedatei"),
    ("[ground zones]", "Bodenzonen"),
    ("[map]", "Karte"),
    ("[gravity]", "Schwerkraft"),
    ("[grounds]", "Böden"),
    ("[catalogue]", "Katalog"),
    ("[scheme]", "Verfahren"),
    ("[capture speed]", "Haftgrenze"),
    ("[tangential answer]", "tangential"),
    ("[impacts on one plane]", "Aufpralle auf Ebene"),
    ("[own dissipation]", "Eigendämpfung"),
    ("[stop rule]", "Stoppregel"),
    ("[trees]", "Bäume"),
    ("[breaking stems]", "brechende Stämme"),
    ("[flight]", "Flug"),
    ("[orientation]", "Lage"),
    ("[shape]", "Form"),
    ("[impacts of blocks]", "Aufpralle von Blöcken"),
    ("[explicit stages]", "explizite Stufen"),
    ("[steps of blocks]", "Schritte von Blöcken"),
    ("[cost of shape]", "Aufwand der Form"),
    ("[flat edges]", "flache Kanten"),
    ("[hollow edges]", "hohle Kanten"),
    ("[corners]", "Ecken"),
    ("[rolling friction]", "Rollreibung"),
    ("[rolling stops]", "Rollen endet"),
    ("[roughness]", "Rauheit"),
    ("[soil]", "Erdreich"),
    ("[rock against rock]", "Block an Block"),
    ("[coupled solve]", "gekoppelte Lösung"),
    ("[bonds]", "Bindungen"),
    ("[paths]", "Bahnen"),
    ("[impacts]", "Aufpralle"),
    ("[lines]", "Linien"),
    ("[barriers]", "Schutzbauwerke"),
    ("[objects]", "Objekte"),
    ("[frequency]", "Häufigkeit"),
    ("[maps]", "Karten"),
    ("[profile]", "Profil"),
    ("[at most]", "höchstens"),
    ("[compared with]", "verglichen mit"),
    ("[warning]", "Warnung"),
    // What the plan says
    (
        "{n} computed rocks are not compared: their runout is less than least_runout_m of [calibrate], and a list of throws holds none that stayed where it was set down.",
        "{n} gerechnete Blöcke werden nicht verglichen: ihre Auslaufstrecke ist kleiner als least_runout_m von [calibrate], und eine Liste von Würfen enthält keinen, der liegen blieb, wo er angesetzt wurde.",
    ),
    (
        "measured ends in {file}, without computed rocks whose runout is less than {least} m",
        "gemessenen Endpunkten in {file}, ohne gerechnete Blöcke, deren Auslaufstrecke kleiner ist als {least} m",
    ),
    ("measured ends in {file}", "gemessenen Endpunkten in {file}"),
    ("left out: {why}", "weggelassen: {why}"),
    ("leapt over: {why}", "übersprungen: {why}"),
    ("the scene has none", "die Szene hat keine"),
    ("no ground has any", "bei keinem Boden angegeben"),
    ("releases are independent", "die Ablösungen sind unabhängig"),
    ("every file has one ground", "jede Datei hat einen Boden"),
    (
        "no ground of trees has breaks_above_j, stems stand for good",
        "kein Boden von Bäumen hat breaks_above_j, Stämme bleiben stehen",
    ),
    (
        "nothing but gravity acts between touches, the parabola is exact",
        "zwischen Berührungen wirkt nur die Schwerkraft, die Parabel ist exakt",
    ),
    (
        "a sphere looks the same from every side; its spin is computed, how far it has turned is not",
        "eine Kugel sieht von allen Seiten gleich aus; ihre Drehung wird gerechnet, ihre Lage nicht",
    ),
    (
        "one rock has 6 unknowns, a dense factor is enough",
        "ein Block hat 6 Unbekannte, ein voller Faktor genügt",
    ),
    (
        "not asked for, [record] impacts = true keeps them",
        "nicht verlangt, [record] impacts = true behält sie",
    ),
    (
        "not asked for, [maps] cell_m = … writes them",
        "nicht verlangt, [maps] cell_m = … schreibt sie",
    ),
    (
        "a bond breaks by its springs, and the rigid limit has none",
        "eine Bindung bricht über ihre Federn, und der starre Grenzfall hat keine",
    ),
    (
        "neither tensile_strength_pa nor cohesion_pa is above 0",
        "weder tensile_strength_pa noch cohesion_pa ist größer als 0",
    ),
    (
        "the scene has no [frequency], every number is conditional on release",
        "die Szene hat kein [frequency], jede Zahl ist bedingt auf die Ablösung",
    ),
    ("the fixed step knows no other", "der feste Schritt kennt nichts anderes"),
    ("every impact is followed step by step", "jeder Aufprall wird Schritt für Schritt verfolgt"),
    ("{count} {place}, seed {seed}", "{count} {place}, Startwert {seed}"),
    ("from {n} points in turn", "reihum von {n} Punkten"),
    ("along a line of {x} m", "entlang einer Linie von {x} m"),
    ("over an area of {x} m²", "auf einer Fläche von {x} m²"),
    ("over {n} zones of {file}, {how}", "auf {n} Zonen von {file}, {how}"),
    (
        "over {n} zones in {m} features of {f}, {how}",
        "auf {n} Zonen aus {m} Objekten von {f}, {how}",
    ),
    ("each a source of its own", "jede eine eigene Quelle"),
    ("shared by their weights", "verteilt nach ihren Gewichten"),
    ("shared by their numbers of points", "verteilt nach ihrer Zahl von Punkten"),
    ("shared by their frequencies", "verteilt nach ihren Häufigkeiten"),
    ("shared by their lengths", "verteilt nach ihren Längen"),
    ("shared by their areas", "verteilt nach ihren Flächen"),
    ("{a} m smallest, {b} m median, {c} m largest", "{a} m kleinster, {b} m Median, {c} m größter"),
    ("{n} triangles in 1 file", "{n} Dreiecke in 1 Datei"),
    ("{n} triangles in {files} files", "{n} Dreiecke in {files} Dateien"),
    (
        "{file}, {n} bytes; names no system of coordinates: taken as the scene's",
        "{file}, {n} Bytes; nennt kein Koordinatensystem: als das der Szene genommen",
    ),
    (
        "{file}, {n} bytes; its system “{name}” has no EPSG code: taken as the scene's",
        "{file}, {n} Bytes; sein System „{name}“ hat keinen EPSG-Code: als das der Szene genommen",
    ),
    ("{file}, {n} bytes", "{file}, {n} Bytes"),
    (
        "{n}, {area} m² in plan view; {k} triangles crossed by a border are {how}",
        "{n}, {area} m² im Grundriss; {k} von einem Rand gequerte Dreiecke sind {how}",
    ),
    (
        "cut into {n}, which gives {area} m² their own ground",
        "in {n} geschnitten, womit {area} m² ihren eigenen Boden haben",
    ),
    (
        "left whole, each with the ground at its centroid; so {area} m² have the ground of the other side; cut = true would mend that with {n} triangles",
        "ganz gelassen, jedes mit dem Boden an seinem Schwerpunkt; so haben {area} m² den Boden der anderen Seite; cut = true behöbe das mit {n} Dreiecken",
    ),
    ("origin {place} m subtracted, no EPSG code", "Ursprung {place} m abgezogen, kein EPSG-Code"),
    ("origin {place} m subtracted, EPSG:{code}", "Ursprung {place} m abgezogen, EPSG:{code}"),
    (
        "{name} like {known}: {values} unless written in the scene; {source}",
        "{name} wie {known}: {values}, wo die Szene nichts anderes schreibt; {source}",
    ),
    ("{name}, local error {x} m/s", "{name}, lokaler Fehler {x} m/s"),
    (
        "no corner goes further than {x} of its rounding in one",
        "keine Ecke bewegt sich in einem weiter als das {x}-fache ihrer Rundung",
    ),
    ("{name}, steps of up to {x} s", "{name}, Schritte bis {x} s"),
    (
        "{name}, steps of {x} s, with shear memory",
        "{name}, Schritte von {x} s, mit Schergedächtnis",
    ),
    (
        "{name}, steps of {x} s, as printed, without shear memory",
        "{name}, Schritte von {x} s, wie gedruckt, ohne Schergedächtnis",
    ),
    (
        "{x} m/s on {name}, for the median rock: slower impacts do not rebound",
        "{x} m/s auf {name}, für den Block vom Median der Größen: langsamere Aufpralle prallen nicht zurück",
    ),
    (
        "{x} m/s on {name}, given: slower impacts do not rebound",
        "{x} m/s auf {name}, vorgegeben: langsamere Aufpralle prallen nicht zurück",
    ),
    (
        "{name}: shear over normal spring {ratio}, tangential restitution {back} where an impact sticks",
        "{name}: Scher- durch Normalfeder {ratio}, tangentialer Rückprall {back}, wo ein Aufprall haftet",
    ),
    ("{name}: shear over normal spring {ratio}", "{name}: Scher- durch Normalfeder {ratio}"),
    ("in no time: the limit of stiff springs", "ohne Dauer: der Grenzfall steifer Federn"),
    (
        "followed as a whole, in their own time; all others step by step",
        "als Ganzes verfolgt, in ihrer eigenen Zeit; alle anderen Schritt für Schritt",
    ),
    (
        "{name}: the scheme itself keeps {all} of the speed; restitution in force",
        "{name}: das Verfahren selbst behält {all} der Geschwindigkeit; Rückprall in Kraft",
    ),
    (
        "{name}: the scheme itself keeps {all} of the speed; beside the ground's own restitution",
        "{name}: das Verfahren selbst behält {all} der Geschwindigkeit; neben dem Rückprall des Bodens",
    ),
    (
        "at rest after {t} s below {v} m/s in contact; time up after {most} s; over budget after {n} steps and flights",
        "in Ruhe nach {t} s unter {v} m/s in Kontakt; Zeit abgelaufen nach {most} s; Budget erschöpft nach {n} Schritten und Flügen",
    ),
    ("{n} triangles", "{n} Dreiecke"),
    ("{n}, each whole again for the next rock", "{n}, jeder für den nächsten Block wieder ganz"),
    ("sphere, weight {n}", "Kugel, Gewicht {n}"),
    ("sphere (block {name}), weight {n}", "Kugel (Block {name}), Gewicht {n}"),
    (
        "{name}, weight {n}, its sides drawn for each rock, of which the median: {a} corner balls of {b} R, {c} edges, {d} faces; reaches {e} R, moments of inertia {f} of the sphere's; rounding takes {g} R off its corners",
        "{name}, Gewicht {n}, Seiten für jeden Block gezogen, davon der Median: {a} Eckkugeln von {b} R, {c} Kanten, {d} Flächen; reicht {e} R weit, Trägheitsmomente {f} der Kugel; die Rundung nimmt {g} R von den Ecken",
    ),
    (
        "{name}, weight {n}: {a} corner balls of {b} R, {c} edges, {d} faces; reaches {e} R, moments of inertia {f} of the sphere's; rounding takes {g} R off its corners",
        "{name}, Gewicht {n}: {a} Eckkugeln von {b} R, {c} Kanten, {d} Flächen; reicht {e} R weit, Trägheitsmomente {f} der Kugel; die Rundung nimmt {g} R von den Ecken",
    ),
    (
        "computed for blocks, free rotation in closed form; left out for spheres, which look the same from every side",
        "gerechnet für Blöcke, freie Drehung in geschlossener Form; weggelassen für Kugeln, die von allen Seiten gleich aussehen",
    ),
    (
        "impacts of blocks, in their own time; those of more than six contacts, and contacts that last, go by implicit stages",
        "Aufpralle von Blöcken, in ihrer eigenen Zeit; solche mit mehr als sechs Kontakten, und Kontakte, die bleiben, gehen in impliziten Stufen",
    ),
    (
        "every impact of a block goes by implicit stages",
        "jeder Aufprall eines Blocks geht in impliziten Stufen",
    ),
    (
        "contact by contact, each with springs of its own: its restitution is that of the ground for the mass that it moves",
        "Kontakt für Kontakt, jeder mit eigenen Federn: sein Rückprall ist der des Bodens für die Masse, die er bewegt",
    ),
    (
        "contact by contact, as springs have it in the limit of great stiffness: restitution along the normal for the mass that a contact moves, and along the surface by the ratio of shear to normal stiffness; how stiff they are plays no part",
        "Kontakt für Kontakt, wie Federn im Grenzfall hoher Steifigkeit: Rückprall entlang der Normalen für die Masse, die ein Kontakt bewegt, und entlang der Oberfläche nach dem Verhältnis von Scher- zu Normalsteifigkeit; wie steif die Federn sind, spielt keine Rolle",
    ),
    (
        "a block is followed corner by corner and edge by edge: time grows with their number",
        "ein Block wird Ecke für Ecke und Kante für Kante verfolgt: die Zeit wächst mit ihrer Zahl",
    ),
    (
        "{k} of {n} left out: the faces beside them touch",
        "{k} von {n} weggelassen: es berühren die Flächen daneben",
    ),
    (
        "all kept, however sharp: a rock so deep in a fold that it reaches the edge presses on both sides as one contact",
        "alle behalten, wie scharf auch immer: ein Block, der so tief in einer Falte liegt, dass er die Kante erreicht, drückt auf beide Seiten als ein Kontakt",
    ),
    (
        "{k} of {n} left out: {a} between edges that rise and edges that fall, {b} in flat ground; an edge or a face is always nearer",
        "{k} von {n} weggelassen: {a} zwischen steigenden und fallenden Kanten, {b} in ebenem Boden; eine Kante oder Fläche ist immer näher",
    ),
    (
        "{k} of {n} rows of {file} have a mass_kg that is not that of their radius_m, line {line} the most: {m} kg, but {r} m at {d} kg/m³ weigh {own} kg; {used} is used",
        "{k} von {n} Zeilen von {file} haben eine mass_kg, die nicht die ihres radius_m ist, am meisten Zeile {line}: {m} kg, aber {r} m mit {d} kg/m³ wiegen {own} kg; {used} gilt",
    ),
    (
        "{said}, write [release] size_from = \"mass_kg\" to use the mass, \"radius_m\" to keep the radius",
        "{said}, [release] size_from = \"mass_kg\" nimmt die Masse, \"radius_m\" behält den Radius",
    ),
    (
        "[grounds.{name}] rolling_friction acts on blocks beside their shape, which already holds them back as they roll: keep only what soft ground takes; a value that was fitted to spheres counts the shape twice",
        "[grounds.{name}] rolling_friction wirkt auf Blöcke neben ihrer Form, die sie beim Rollen schon bremst: nur angeben, was weicher Boden nimmt; ein an Kugeln angepasster Wert zählt die Form doppelt",
    ),
    ("computed", "gerechnet"),
    (
        "{name}: a block by its shape; on a face, if it does not tip, it stays on slopes of up to {x}° ({a}° to {b}°), the friction angle",
        "{name}: ein Block durch seine Form; auf einer Fläche bleibt er, wenn er nicht kippt, an Hängen bis {x}° ({a}° bis {b}°) liegen, dem Reibungswinkel",
    ),
    (
        "{name}: a block by its shape; on a face, if it does not tip, it stays on slopes of up to {x}°, the friction angle",
        "{name}: ein Block durch seine Form; auf einer Fläche bleibt er, wenn er nicht kippt, an Hängen bis {x}° liegen, dem Reibungswinkel",
    ),
    (
        "{name}: on no slope, it has no rolling friction",
        "{name}: an keinem Hang, er hat keine Rollreibung",
    ),
    (
        "{name}: on slopes of up to {x}° ({a}° to {b}°)",
        "{name}: an Hängen bis {x}° ({a}° bis {b}°)",
    ),
    ("{name}: on slopes of up to {x}°", "{name}: an Hängen bis {x}°"),
    (
        "one facet for every roughness length of the way, leaping, sliding or rolling",
        "eine Facette auf jeder Rauheitslänge des Weges, im Springen, Gleiten oder Rollen",
    ),
    (
        "{name}: friction grows with slip, from {a} to {b}",
        "{name}: Reibung wächst mit dem Gleitweg, von {a} bis {b}",
    ),
    (
        "{name}: the median rock that falls on it at {v} m/s digs in {d} m and loses {x} % of its speed on the way",
        "{name}: der Block vom Median der Größen, der mit {v} m/s senkrecht auftrifft, gräbt sich {d} m tief ein und verliert auf dem Weg {x} % seiner Geschwindigkeit",
    ),
    (
        "{name}: half of the restitution is left at {v} m/s",
        "{name}: die Hälfte des Rückpralls bleibt bei {v} m/s",
    ),
    (
        "one world: {springs}, friction angle {angle}°, restitution of the scheme itself",
        "eine Welt: {springs}, Reibungswinkel {angle}°, Rückprall des Verfahrens selbst",
    ),
    (
        "one world: {springs}, friction angle {angle}°, restitution {e}",
        "eine Welt: {springs}, Reibungswinkel {angle}°, Rückprall {e}",
    ),
    ("springs of {a} and {b} N/m", "Federn von {a} und {b} N/m"),
    (
        "springs left out: the rigid limit has none",
        "Federn weggelassen: der starre Grenzfall hat keine",
    ),
    (
        "islands of rocks that may touch, each with its own step; impacts in the order of their times, sustained contact swept",
        "Inseln von Blöcken, die sich berühren können, jede mit eigenem Schritt; Aufpralle in zeitlicher Folge, anhaltender Kontakt in Durchläufen",
    ),
    (
        "islands of rocks that may touch, each with its own step",
        "Inseln von Blöcken, die sich berühren können, jede mit eigenem Schritt",
    ),
    (
        "between rocks that touch at the start: tensile strength {a} Pa, cohesion {b} Pa",
        "zwischen Blöcken, die sich am Anfang berühren: Zugfestigkeit {a} Pa, Kohäsion {b} Pa",
    ),
    (
        "kept for {k} of {n} releases, every {t} s",
        "behalten für {k} von {n} Ablösungen, alle {t} s",
    ),
    ("kept", "behalten"),
    (
        "{n}: {all}; crossings exact between stored points",
        "{n}: {all}; Durchgänge exakt zwischen gespeicherten Punkten",
    ),
    (
        "{all}: judged on the rocks that cross, they change no way",
        "{all}: an den querenden Blöcken beurteilt, sie ändern keine Bahn",
    ),
    (
        "{all}: hit when the rim of a rock comes over them",
        "{all}: getroffen, wenn der Rand eines Blocks darüber kommt",
    ),
    ("{name} ({a} m long, {b} m wide, {rest})", "{name} ({a} m lang, {b} m breit, {rest})"),
    ("{name} ({a} m long, {b} m wide)", "{name} ({a} m lang, {b} m breit)"),
    ("{a} m long, {b} m wide, {rest}", "{a} m lang, {b} m breit, {rest}"),
    ("{name} ({a} m², {rest})", "{name} ({a} m², {rest})"),
    ("{n} vehicles a day of {l} m at {v} km/h", "{n} Fahrzeuge am Tag von {l} m mit {v} km/h"),
    ("{n} passages a day of one person", "{n} Fahrten am Tag einer Person"),
    ("occupied {x} of the time", "belegt {x} der Zeit"),
    ("{x} persons", "{x} Personen"),
    ("vulnerability {x}", "Verletzlichkeit {x}"),
    (
        "{name}: {a} V^-{b} events a year of V m³ or more, {c} to {d} m³",
        "{name}: {a} V^-{b} Ereignisse pro Jahr von V m³ oder mehr, {c} bis {d} m³",
    ),
    (
        "{a} V^-{b} events a year of V m³ or more, {c} to {d} m³",
        "{a} V^-{b} Ereignisse pro Jahr von V m³ oder mehr, {c} bis {d} m³",
    ),
    (
        "{name}: {a} events a year of the scene's rocks",
        "{name}: {a} Ereignisse pro Jahr mit den Blöcken der Szene",
    ),
    ("{a} events a year of the scene's rocks", "{a} Ereignisse pro Jahr mit den Blöcken der Szene"),
    (
        "{a} events a year; 1 class of size and source: {d} rocks are as precise as {e} of equal weight",
        "{a} Ereignisse pro Jahr; 1 Klasse von Größe und Quelle: {d} Blöcke sind so aussagekräftig wie {e} gleichen Gewichts",
    ),
    (
        "{a} events a year; {b} classes of size and source, {c} rocks or more each: {d} rocks are as precise as {e} of equal weight",
        "{a} Ereignisse pro Jahr; {b} Klassen von Größe und Quelle, je {c} Blöcke oder mehr: {d} Blöcke sind so aussagekräftig wie {e} gleichen Gewichts",
    ),
    ("levels of “{name}”; source: {source}", "Stufen von „{name}“; Quelle: {source}"),
    (
        "{name}: {a} a year of {b} to {c} m³, {rest}",
        "{name}: {a} pro Jahr von {b} bis {c} m³, {rest}",
    ),
    ("{a} a year of {b} to {c} m³, {rest}", "{a} pro Jahr von {b} bis {c} m³, {rest}"),
    ("{a} a year of {b} to {c} m³", "{a} pro Jahr von {b} bis {c} m³"),
    ("{a} x {b} cells of {c} m", "{a} x {b} Zellen von {c} m"),
    (
        "speed and height every {x} m from the release, over all rocks",
        "Geschwindigkeit und Höhe alle {x} m ab der Ablösung, über alle Blöcke",
    ),
    (
        "{a} {kind_a} of memory, and about {b} {kind_b} of disk ({files}): {n} releases, up to {p} points of paths, {c} cells of maps; runs with --yes only",
        "{a} {kind_a} Speicher, und etwa {b} {kind_b} Platte ({files}): {n} Ablösungen, bis {p} Bahnpunkte, {c} Kartenzellen; läuft nur mit --yes",
    ),
    (
        "{a} {kind_a} of memory, and about {b} {kind_b} of disk ({files}): {n} releases, up to {p} points of paths, {c} cells of maps",
        "{a} {kind_a} Speicher, und etwa {b} {kind_b} Platte ({files}): {n} Ablösungen, bis {p} Bahnpunkte, {c} Kartenzellen",
    ),
    ("measured ends in {file}", "gemessene Endpunkte in {file}"),
    (
        "{a} of {b} releases tried out, over steep ground, by more than a tenth of their radius and up to {c} m, until they just touch: they fall from higher than height_m says",
        "{a} von {b} probeweise abgelösten Blöcken, über steilem Boden, um mehr als ein Zehntel ihres Radius und bis {c} m, bis sie gerade berühren: sie fallen von höher, als height_m sagt",
    ),
    (
        "the same number of rocks is computed for every source, however often it releases them in a year. Percentiles, shares and maps are weighted back and hold for the sources as they are; counts of rocks and dots in figures show rocks as computed",
        "von jeder Quelle werden gleich viele Blöcke gerechnet, wie oft auch immer sie im Jahr welche ablöst. Perzentile, Anteile und Karten sind zurückgewichtet und gelten für die Quellen, wie sie sind; Anzahlen und Punkte in Abbildungen zeigen Blöcke wie gerechnet",
    ),
];
