//! What the terms mean here, language by language.

type Glossary = [(&'static str, &'static str); 24];

pub(super) const DE: Glossary = [
    (
        "Perzentil",
        "Über die Blöcke, vom Wert jedes Blocks: seinem größten unterwegs oder dem beim ersten Durchgang einer Linie. In Karten: vom größten Wert jedes Blocks in der Zelle. P95 ist der Wert, den 95 % der Blöcke nicht überschreiten.",
    ),
    (
        "95-%-Intervall",
        "Für Perzentile aus Ordnungsstatistiken, ohne Annahme einer Verteilung; bei Blöcken ungleichen Gewichts nach Woodruff: die Werte, bei denen der gewichtete Anteil darunter das Perzentil in seinem eigenen Intervall lässt. Für Anteile das exakte Intervall nach Clopper und Pearson; bei keinem und bei allen von n die einseitige Schranke 1 − 0.05^(1/n). Für Mittelwerte die äußeren Enden der Intervalle nach Student und Hall. Es deckt nur den Zufall der Stichprobe ab.",
    ),
    (
        "≥ und ≤",
        "Die Zahl ist eine Schranke: Blöcke, die das Gelände verließen, sich am Ende ihrer Zeit noch bewegten oder fehlschlugen, wären weitergelaufen. Ihre Auslaufstrecke ist mindestens, ihr Pauschalgefälle höchstens der gesehene Wert; ein Perzentil, das von ihnen abhängt, ist ebenfalls eine Schranke. Die Wahrheit liegt auf dieser Seite, wie auch immer die Blöcke weitergelaufen wären, und im Intervall; sind es zu viele, hat es auf dieser Seite kein Ende.",
    ),
    (
        "Mit und ohne Schutzbauwerke",
        "Ohne: alle Blöcke, die die Linie überqueren. Mit: jene, die kein Bauwerk davor aufhält. Ein Block, den ein Bauwerk durchlässt, behält seine Energie.",
    ),
    ("Auslaufstrecke", "Horizontale Strecke von der Ablösung bis zum Ende."),
    (
        "Pauschalgefälle",
        "atan(Höhenverlust / Auslaufstrecke), beides von der Ablösung bis zum Ende gemessen.",
    ),
    (
        "Sprunghöhe",
        "Lotrechter Abstand vom Gelände darunter zum tiefsten Punkt des Blocks. Ein Schutzbauwerk braucht sie auch rechtwinklig zum Hang.",
    ),
    ("Translationsenergie", "m v²/2 des Mittelpunkts."),
    ("Rotationsenergie", "I ω²/2 mit I = 2/5 m R²."),
    (
        "Gesamtenergie",
        "Summe beider im selben Zeitpunkt; ihr größter Wert ist nicht die Summe der beiden größten.",
    ),
    (
        "Erreichenswahrscheinlichkeit",
        "Durchgänge durch Ablösungen: bedingt auf die Ablösung. Sie ist keine Häufigkeit; dazu braucht es die Häufigkeit der Ablösungen.",
    ),
    (
        "Ende",
        "Zur Ruhe gekommen: während der Ruhezeit langsamer als die Ruhegeschwindigkeit, in Kontakt. Gelände verlassen: über den Rand der Dreiecksnetze hinaus. Zeit abgelaufen: noch in Bewegung bei der längsten gerechneten Zeit. Fehlgeschlagen: die Rechnung konnte nicht fortfahren.",
    ),
    (
        "Auswertelinie",
        "Ein lotrechter Vorhang über einer Linie der Karte. Die Werte gelten beim ersten Durchgang eines Blocks, auf der Parabel oder dem Schritt, der sie quert; ein zurückkehrender Block wird gezählt, spätere Durchgänge gehen in keine Statistik ein.",
    ),
    (
        "Rückhalt",
        "Anteil der Ablösungen, der eine Linie nicht erreicht: was zwischen zwei Linien fehlt, blieb dort liegen oder verließ das Gelände.",
    ),
    (
        "Höhe rechtwinklig zum Hang",
        "Abstand von der Ebene des Dreiecks darunter zum Block, rechtwinklig zu diesem Dreieck: die Höhe, die ein rechtwinklig zum Hang stehendes Bauwerk haben muss.",
    ),
    (
        "Schutzbauwerk",
        "Eine Linie mit Höhe und Energieaufnahme. Es hält einen Block auf, dessen oberster Punkt nicht über seiner Oberkante liegt und dessen Gesamtenergie es aufnimmt, und ändert in der Rechnung keines Blockes Weg; was es aufhält, kommt bei den folgenden nicht an.",
    ),
    (
        "Bemessungsenergie, Bemessungshöhe",
        "Ein Perzentil über die ankommenden Blöcke mal die einzeln angegebenen Teilsicherheitsbeiwerte, bei der Höhe zuzüglich Freibord. Beiwerte auf die Geschwindigkeit gehen im Quadrat in die Energie ein. Mit einem Bemessungsblock ist die Energie seine halbe Masse mal das Quadrat des Perzentils der Geschwindigkeit. P95 braucht 59 Blöcke, P99 299: mit weniger gibt es keinen Wert. Das Intervall ist das des Perzentils.",
    ),
    (
        "Intensität",
        "Schweizer Klassen nach dem 95. Perzentil der Gesamtenergie der Blöcke, die eine Zelle durchqueren: schwach unter 30 kJ, mittel 30 bis 300 kJ, stark über 300 kJ. Die größte Energie wüchse mit der Zahl der Ablösungen.",
    ),
    (
        "Bedingt auf die Ablösung, pro Jahr",
        "Bedingt auf die Ablösung: unter der Voraussetzung, dass ein Block abgelöst ist; ein Anteil der Ablösungen. Pro Jahr: wie oft es geschieht, mit der Häufigkeit der Quellen. Nur Tabellen und Abbildungen, die „pro Jahr“ oder „Wiederkehrperiode“ sagen, enthalten Zahlen der zweiten Art.",
    ),
    (
        "Durchgangshäufigkeit, Energieüberschreitung",
        "Ablösehäufigkeit (Ereignisse pro Jahr an einer Quelle) mal Erreichenswahrscheinlichkeit (bedingt auf die Ablösung), summiert über Quellen und Größen; die Energieüberschreitung λ(E ≥ e) zählt nur Durchgänge mit mindestens der Gesamtenergie e.",
    ),
    (
        "Wiederkehrperiode",
        "1/λ. Die Energie einer Wiederkehrperiode T ist jene mit λ(E ≥ e) = 1/T. Die Wahrscheinlichkeit für eines oder mehr in einem Jahr ist 1 − e^−λ.",
    ),
    (
        "Treffer eines Objekts",
        "Von oben gesehen gelangt der Rand des Blocks über das Objekt: innerhalb (Breite + Durchmesser)/2 seiner Linie oder eines halben Durchmessers von seinem Umriss, in beliebiger Höhe. Jeder Block zählt einmal, mit seiner Energie in diesem Augenblick.",
    ),
    (
        "Durchgänge und Ablagerungen",
        "Blöcke, die in einer Zelle waren, jeder einmal gezählt; Blöcke, die darin zur Ruhe kamen.",
    ),
    (
        "KS-Abstand (Kolmogorow und Smirnow)",
        "Größter Unterschied zweier Verteilungsfunktionen (0 bis 1). Die 5-%-Grenze überschreiten zwei Stichproben dieser Größe aus ein und derselben Verteilung einmal in zwanzig Fällen, jedes Ende für sich gezählt: wo sich Würfe eines Blocks ähneln, ist sie größer.",
    ),
];

pub(super) const FR: Glossary = [
    (
        "Centile",
        "Sur les blocs, de la valeur de chacun\u{a0}: la plus grande en chemin, ou celle du premier passage d’une ligne. Sur les cartes\u{a0}: de la plus grande valeur de chaque bloc dans la maille. P95 est la valeur que 95 % des blocs ne dépassent pas.",
    ),
    (
        "Intervalle à 95 %",
        "Pour les centiles, par statistiques d’ordre, sans loi supposée\u{a0}; pour des blocs de poids différents celui de Woodruff\u{a0}: les valeurs pour lesquelles la part pondérée au-dessous laisse le centile dans son propre intervalle. Pour les parts, l’intervalle exact de Clopper et Pearson\u{a0}; pour aucun et pour tous sur n, la borne unilatérale 1 − 0.05^(1/n). Pour les moyennes, les bouts extrêmes des intervalles de Student et de Hall. Il ne couvre que l’aléa de l’échantillon.",
    ),
    (
        "≥ et ≤",
        "Le nombre est une borne\u{a0}: les blocs sortis du terrain, encore en mouvement à la fin de leur temps ou en échec, auraient continué. Leur distance est au moins, leur angle d’énergie au plus ce qui a été vu\u{a0}; un centile qui en dépend est aussi une borne. La vérité se trouve de ce côté, quelle qu’eût été la suite, et dans l’intervalle\u{a0}; s’ils sont trop nombreux, il n’a pas de fin de ce côté.",
    ),
    (
        "Avec et sans ouvrages",
        "Sans\u{a0}: tous les blocs qui franchissent la ligne. Avec\u{a0}: ceux qu’aucun ouvrage n’arrête avant. Un bloc qu’un ouvrage laisse passer garde son énergie.",
    ),
    ("Distance de propagation", "Distance horizontale du départ à l’arrêt."),
    ("Angle d’énergie (Fahrböschung)", "atan(dénivelée / distance), mesurées du départ à l’arrêt."),
    (
        "Hauteur de rebond",
        "Distance verticale du terrain au-dessous au point le plus bas du bloc. Un ouvrage en a aussi besoin perpendiculairement au versant.",
    ),
    ("Énergie de translation", "m v²/2 du centre."),
    ("Énergie de rotation", "I ω²/2 avec I = 2/5 m R²."),
    (
        "Énergie totale",
        "Somme des deux au même instant\u{a0}; son maximum n’est pas la somme des deux maxima.",
    ),
    (
        "Probabilité d’atteinte",
        "Passages sur départs\u{a0}: conditionnelle au départ. Ce n’est pas une fréquence\u{a0}; il y faut la fréquence des départs.",
    ),
    (
        "Arrêt",
        "À l’arrêt\u{a0}: plus lent que la vitesse de repos pendant le temps de repos, en contact. Sorti du terrain\u{a0}: au-delà du bord des maillages. Temps écoulé\u{a0}: encore en mouvement au plus long temps simulé. Échec\u{a0}: le calcul n’a pu continuer.",
    ),
    (
        "Ligne d’évaluation",
        "Un rideau vertical sur une ligne de la carte. Les valeurs sont celles du premier passage d’un bloc, sur la parabole ou le pas qui la coupe\u{a0}; un bloc qui revient est compté, ses passages suivants n’entrent dans aucune statistique.",
    ),
    (
        "Rétention",
        "Part des départs qui n’atteint pas une ligne\u{a0}: ce qui manque entre deux lignes s’y est arrêté ou a quitté le terrain.",
    ),
    (
        "Hauteur normale au versant",
        "Distance du plan du triangle au-dessous au bloc, perpendiculairement à ce triangle\u{a0}: la hauteur que doit avoir un ouvrage perpendiculaire au versant.",
    ),
    (
        "Ouvrage de protection",
        "Une ligne avec une hauteur et une capacité d’énergie. Il arrête un bloc dont le point le plus haut ne dépasse pas son arête et dont il absorbe l’énergie totale, et ne change le parcours d’aucun bloc dans le calcul\u{a0}; ce qu’il arrête n’atteint pas les suivants.",
    ),
    (
        "Énergie et hauteur de dimensionnement",
        "Un centile sur les blocs qui arrivent, fois les facteurs partiels indiqués un à un, plus la hauteur libre pour la hauteur. Les facteurs sur la vitesse entrent au carré dans l’énergie. Avec un bloc de projet, l’énergie est la moitié de sa masse fois le carré du centile de la vitesse. P95 exige 59 blocs, P99 299\u{a0}: avec moins il n’y en a pas. L’intervalle est celui du centile.",
    ),
    (
        "Intensité",
        "Classes suisses selon le centile 95 de l’énergie totale des blocs qui traversent une maille\u{a0}: faible sous 30 kJ, moyenne de 30 à 300 kJ, forte au-dessus de 300 kJ. L’énergie maximale croîtrait avec le nombre de départs.",
    ),
    (
        "Conditionnel au départ, par an",
        "Conditionnel au départ\u{a0}: sachant qu’un bloc est parti\u{a0}; une part des départs. Par an\u{a0}: combien de fois cela arrive, fréquence des sources comprise. Seuls les tableaux et figures qui disent «\u{a0}par an\u{a0}» ou «\u{a0}période de retour\u{a0}» contiennent des nombres du second genre.",
    ),
    (
        "Fréquence de passage, dépassement d’énergie",
        "Fréquence de rupture (événements par an à une source) fois probabilité d’atteinte (conditionnelle au départ), sommée sur sources et tailles\u{a0}; le dépassement λ(E ≥ e) ne compte que les passages d’énergie totale au moins e.",
    ),
    (
        "Période de retour",
        "1/λ. L’énergie d’une période de retour T est celle où λ(E ≥ e) = 1/T. La probabilité d’un passage ou plus en un an est 1 − e^−λ.",
    ),
    (
        "Impact sur un objet",
        "Vu d’en haut, le bord du bloc arrive sur l’objet\u{a0}: à moins de (largeur + diamètre)/2 de sa ligne, ou d’un demi-diamètre de son contour, à toute hauteur. Chaque bloc compte une fois, avec son énergie à cet instant.",
    ),
    (
        "Passages et dépôts",
        "Blocs qui ont été dans une maille, chacun compté une fois\u{a0}; blocs qui s’y sont arrêtés.",
    ),
    (
        "Distance KS (Kolmogorov et Smirnov)",
        "La plus grande différence entre deux fonctions de répartition (0 à 1). Sa limite à 5 % est celle que deux échantillons de ces tailles d’une même loi dépassent une fois sur vingt, chaque arrêt compté pour un\u{a0}: si les lancers d’un même bloc se ressemblent, elle est plus grande.",
    ),
];

pub(super) const IT: Glossary = [
    (
        "Percentile",
        "Sui massi, del valore di ciascuno: il massimo lungo il percorso, o quello al primo passaggio di una linea. Sulle mappe: del massimo di ogni masso nella cella. P95 è il valore che il 95 % dei massi non supera.",
    ),
    (
        "Intervallo al 95 %",
        "Per i percentili da statistiche d’ordine, senza supporre una distribuzione; per massi di peso diverso quello di Woodruff: i valori per i quali la percentuale pesata al di sotto lascia il percentile nel proprio intervallo. Per le percentuali l’intervallo esatto di Clopper e Pearson; per nessuno e per tutti su n il limite unilaterale 1 − 0.05^(1/n). Per le medie gli estremi esterni degli intervalli di Student e di Hall. Copre solo il caso nel campione.",
    ),
    (
        "≥ e ≤",
        "Il numero è un limite: i massi usciti dal terreno, ancora in moto allo scadere del tempo o falliti, avrebbero proseguito. La loro distanza è almeno, il loro angolo al massimo quello visto; un percentile che ne dipende è anch’esso un limite. La verità sta da quel lato, comunque avessero proseguito, e nell’intervallo; se sono troppi, esso non ha estremo da quel lato.",
    ),
    (
        "Con e senza barriere",
        "Senza: tutti i massi che attraversano la linea. Con: quelli che nessuna barriera ferma prima. Un masso che una barriera lascia passare mantiene la sua energia.",
    ),
    ("Distanza di arresto", "Distanza orizzontale dal distacco all’arresto."),
    (
        "Angolo di propagazione (Fahrböschung)",
        "atan(dislivello / distanza), misurati dal distacco all’arresto.",
    ),
    (
        "Altezza di rimbalzo",
        "Distanza verticale dal terreno sottostante al punto più basso del masso. A una barriera serve anche perpendicolarmente al versante.",
    ),
    ("Energia traslazionale", "m v²/2 del centro."),
    ("Energia rotazionale", "I ω²/2 con I = 2/5 m R²."),
    (
        "Energia totale",
        "Somma delle due nello stesso istante; il suo massimo non è la somma dei due massimi.",
    ),
    (
        "Probabilità di raggiungimento",
        "Passaggi su distacchi: condizionata al distacco. Non è una frequenza; per quella serve la frequenza dei distacchi.",
    ),
    (
        "Arresto",
        "A riposo: più lento della velocità di riposo per il tempo di riposo, in contatto. Uscito dal terreno: oltre il bordo delle maglie. Tempo scaduto: ancora in moto al tempo massimo simulato. Fallito: il calcolo non ha potuto proseguire.",
    ),
    (
        "Linea di valutazione",
        "Una cortina verticale sopra una linea della mappa. I valori sono quelli del primo passaggio di un masso, sulla parabola o sul passo che la taglia; un masso che ritorna è contato, i suoi passaggi successivi non entrano in alcuna statistica.",
    ),
    (
        "Ritenzione",
        "Percentuale dei distacchi che non raggiunge una linea: ciò che manca fra due linee si è fermato lì o ha lasciato il terreno.",
    ),
    (
        "Altezza normale al versante",
        "Distanza dal piano del triangolo sottostante al masso, perpendicolare a tale triangolo: l’altezza che deve avere una barriera perpendicolare al versante.",
    ),
    (
        "Barriera",
        "Una linea con un’altezza e una capacità di energia. Ferma un masso il cui punto più alto non supera il suo bordo e la cui energia totale essa assorbe, e non cambia il percorso di alcun masso nel calcolo; ciò che ferma non arriva a quelle dietro.",
    ),
    (
        "Energia e altezza di progetto",
        "Un percentile sui massi in arrivo, per i coefficienti parziali indicati uno a uno, e per l’altezza più il franco. I coefficienti sulla velocità entrano al quadrato nell’energia. Con un blocco di progetto l’energia è metà della sua massa per il quadrato del percentile della velocità. P95 richiede 59 massi, P99 299: con meno non c’è alcun valore. L’intervallo è quello del percentile.",
    ),
    (
        "Intensità",
        "Classi svizzere secondo il 95-esimo percentile dell’energia totale dei massi che passano in una cella: debole sotto 30 kJ, media da 30 a 300 kJ, forte sopra 300 kJ. L’energia massima crescerebbe con il numero dei distacchi.",
    ),
    (
        "Condizionato al distacco, all’anno",
        "Condizionato al distacco: dato che un masso si è staccato; una percentuale dei distacchi. All’anno: quante volte accade, compresa la frequenza delle sorgenti. Solo tabelle e figure che dicono «all’anno» o «tempo di ritorno» contengono numeri del secondo tipo.",
    ),
    (
        "Frequenza di passaggio, superamento di energia",
        "Frequenza di distacco (eventi all’anno a una sorgente) per probabilità di raggiungimento (condizionata al distacco), sommata su sorgenti e dimensioni; il superamento λ(E ≥ e) conta solo i passaggi con energia totale almeno e.",
    ),
    (
        "Tempo di ritorno",
        "1/λ. L’energia di un tempo di ritorno T è quella con λ(E ≥ e) = 1/T. La probabilità di uno o più in un anno è 1 − e^−λ.",
    ),
    (
        "Colpo su un oggetto",
        "Visto dall’alto, il bordo del masso arriva sopra l’oggetto: entro (larghezza + diametro)/2 dalla sua linea, o mezzo diametro dal suo contorno, a qualsiasi altezza. Ogni masso conta una volta, con la sua energia in quell’istante.",
    ),
    (
        "Passaggi e depositi",
        "Massi che sono stati in una cella, ciascuno contato una volta; massi che vi si sono fermati.",
    ),
    (
        "Distanza KS (Kolmogorov e Smirnov)",
        "La massima differenza fra due funzioni di ripartizione (da 0 a 1). Il suo limite al 5 % è quello che due campioni di tali dimensioni dalla stessa distribuzione superano una volta su venti, ogni arresto contato per sé: dove i lanci di uno stesso blocco si somigliano è maggiore.",
    ),
];

pub(super) const EN: Glossary = [
    (
        "Percentile",
        "Over rocks, of each rock's value: its largest along the way, or at its first crossing of a line. On maps: of each rock's largest value in the cell. P95 is the value that 95 % of the rocks do not exceed.",
    ),
    (
        "95 % interval",
        "For percentiles from order statistics, which assumes no distribution; of rocks that differ in weight Woodruff’s: the values at which the weighted share below them leaves the percentile within its own interval. For shares the exact interval of Clopper and Pearson; for none and all of n the one-sided bound 1 − 0.05^(1/n). For means the outer ends of Student’s and Hall’s intervals. It covers chance in the sample only.",
    ),
    (
        "≥ and ≤",
        "The number is a bound: rocks that left the terrain, were still moving when their time was up, or failed, would have gone on. Their runout is at least, their reach angle at most what was seen; a percentile that they decide is a bound too. The truth lies on that side however the rocks would have gone on, and within the interval; where they are too many it has no end on that side.",
    ),
    (
        "With and without barriers",
        "Without: all rocks that cross the line. With: those that no barrier stops before it. A rock that a barrier lets through keeps its energy.",
    ),
    ("Runout", "Horizontal distance from release to end."),
    (
        "Reach angle (Fahrböschung)",
        "atan(drop / runout), drop and runout measured from release to end.",
    ),
    (
        "Bounce height",
        "Vertical distance from the ground below to the lowest point of the rock. A barrier also needs it at right angles to the slope.",
    ),
    ("Translational energy", "m v²/2 of the centre."),
    ("Rotational energy", "I ω²/2 with I = 2/5 m R²."),
    (
        "Total energy",
        "The sum of both at one instant; its largest value is not the sum of the two largest.",
    ),
    (
        "Reach probability",
        "Crossings over releases: conditional on release. It is not a frequency; that needs the frequency of releases.",
    ),
    (
        "Stop",
        "At rest: slower than the rest speed for the rest time, in contact. Left the terrain: beyond the edge of the meshes. Time up: still moving at the longest simulated time. Failed: the computation could not go on.",
    ),
    (
        "Evaluation line",
        "A vertical curtain over a line of the map. Values are those at a rock's first crossing of it, found on the parabola or the step that crosses; a rock that comes back is counted, its later crossings are in no statistic.",
    ),
    (
        "Retention",
        "The share of releases that does not reach a line: what is missing between two lines has stopped there or left the terrain.",
    ),
    (
        "Height normal to the slope",
        "Distance from the plane of the triangle below to the rock, at right angles to that triangle: the height that a barrier standing at right angles to the slope must have.",
    ),
    (
        "Barrier",
        "A line with a height and an energy capacity. It stops a rock whose highest point is not above its edge and whose total energy it takes, and changes no rock's way in the computation; what it stops does not arrive at those behind it.",
    ),
    (
        "Design energy, design height",
        "A percentile over the rocks that arrive, times the partial factors that are printed one by one, and for the height plus the free height. Factors on the speed enter the energy squared. With a design block the energy is half its mass times the square of the percentile of speed. P95 needs 59 rocks, P99 299: with fewer there is none. The interval is that of the percentile.",
    ),
    (
        "Intensity",
        "Swiss classes of the 95th percentile of total energy of the rocks that pass a cell: weak below 30 kJ, medium 30 to 300 kJ, strong above 300 kJ. The largest energy would grow with the number of releases.",
    ),
    (
        "Conditional on release, a year",
        "Conditional on release: given that a rock has been released; a share of releases or events. A year: how often it happens, the sources' own frequency included. Only tables and figures that say “a year” or “return period” hold numbers of the second kind.",
    ),
    (
        "Passage frequency, energy exceedance",
        "Failure frequency (events a year at a source) times reach probability (conditional on release), summed over sources and sizes; energy exceedance λ(E ≥ e) counts passages with at least the total energy e only.",
    ),
    (
        "Return period",
        "1/λ. The energy of a return period T is the one with λ(E ≥ e) = 1/T. The probability of one or more in a year is 1 − e^−λ.",
    ),
    (
        "Hit of an object",
        "Seen from above, the rim of the rock comes over the object: within (width + diameter)/2 of its line, or half a diameter of its outline. At any height. Each rock counts once, with its energy at that moment.",
    ),
    (
        "Passages and deposits",
        "Rocks that have been in a cell, each counted once; rocks that came to rest in it.",
    ),
    (
        "KS distance (Kolmogorov and Smirnov)",
        "The largest difference between two cumulative distributions (0 to 1). Its 5 % limit is what two samples of these sizes from one and the same distribution exceed once in twenty times, each end counted by itself: where throws of one block are alike it is larger.",
    ),
];
