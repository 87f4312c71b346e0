//! A reader of the SVG that the report writes, just strict enough to find what a viewer would stumble over.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on has failed")]

/// Fails when a drawing is not well-formed, holds a number that is none, or draws beyond its paper.
pub(crate) fn check(svg: &str, place: &str) {
    check_nesting(svg, place);
    let root = svg.split('>').next().unwrap();
    let view: Vec<f64> =
        attribute(root, "viewBox").unwrap().split(' ').map(|v| v.parse().unwrap()).collect();
    let inside = |x: f64, y: f64| {
        // half a line's width may stand over
        (-5.0..=view[2] + 5.0).contains(&x) && (-5.0..=view[3] + 5.0).contains(&y)
    };
    for tag in svg.split('<').skip(1).filter_map(|rest| rest.split('>').next()) {
        for (x, y) in points(tag) {
            assert!(
                inside(x, y),
                "{place}: ({x}, {y}) is off the paper in <{}",
                &tag[..tag.len().min(120)]
            );
        }
    }
}

/// The text between the tags.
pub(crate) fn strip_tags(text: &str) -> String {
    let mut words = String::new();
    let mut is_tag = false;
    for c in text.chars() {
        match c {
            '<' => is_tag = true,
            '>' => is_tag = false,
            c if !is_tag => words.push(c),
            _ => {}
        }
    }
    words.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&").replace("&#39;", "'")
}

/// Every element closes in order; every attribute number is a number.
pub(crate) fn check_nesting(text: &str, place: &str) {
    const EMPTY: [&str; 3] = ["meta", "br", "!DOCTYPE"];
    let mut open: Vec<&str> = Vec::new();
    for rest in text.split('<').skip(1) {
        let (tag, _) = rest.split_once('>').unwrap_or_else(|| panic!("{place}: `<` without `>`"));
        let name = tag.trim_start_matches('/').split([' ', '/', '\n']).next().unwrap();
        assert!(!has_no_number(tag), "{place}: <{}>", &tag[..tag.len().min(200)]);
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "{place}: </{name}> closes another");
        } else if !tag.ends_with('/') && !EMPTY.contains(&name) {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "{place}: not closed: {open:?}");
}

fn has_no_number(tag: &str) -> bool {
    let is_picture = tag.starts_with("image");
    !is_picture
        && tag.split('"').skip(1).step_by(2).any(|value| {
            value.contains("NaN")
                || value.split([' ', ',']).any(|w| w.trim_start_matches('-').starts_with("inf"))
        })
}

pub(crate) fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) =
        tag.split_once(&format!(" {name}=\"")).or_else(|| tag.split_once(&format!("{name}=\"")))?;
    rest.split('"').next()
}

/// All points that an element draws through.
pub(crate) fn points(tag: &str) -> Vec<(f64, f64)> {
    let number =
        |name: &str| attribute(tag, name).and_then(|v| v.parse::<f64>().ok()).unwrap_or(0.0);
    if let Some(data) = tag.strip_prefix("path d=\"") {
        return path_points(data.split('"').next().unwrap());
    }
    match tag.split(' ').next().unwrap() {
        "rect" | "image" => {
            let (x, y) = (number("x"), number("y"));
            vec![(x, y), (x + number("width"), y + number("height"))]
        }
        "circle" => vec![(number("cx"), number("cy"))],
        "text" => vec![(number("x"), number("y"))],
        _ => Vec::new(),
    }
}

fn path_points(data: &str) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    let (mut x, mut y) = (0.0, 0.0);
    let mut rest = data;
    while let Some(command) = rest.chars().next() {
        let end = rest[1..].find(|c: char| c.is_ascii_alphabetic()).map_or(rest.len(), |i| i + 1);
        let numbers = numbers(&rest[1..end]);
        match (command, &numbers[..]) {
            ('M', &[a, b]) => (x, y) = (a, b),
            ('l', &[a, b]) => (x, y) = (x + a, y + b),
            ('h', &[a]) => x += a,
            ('v', &[a]) => y += a,
            ('z', []) => {}
            other => panic!("unexpected path command {other:?}"),
        }
        found.push((x, y));
        rest = &rest[end..];
    }
    found
}

fn numbers(text: &str) -> Vec<f64> {
    text.replace('-', " -").split_whitespace().map(|n| n.parse().unwrap()).collect()
}

/// All points of paths with a stroke of some colour.
pub(crate) fn stroked_with(svg: &str, colour: &str) -> Vec<(f64, f64)> {
    let tags = svg.split('<').skip(1).filter_map(|rest| rest.split('>').next());
    tags.filter(|tag| attribute(tag, "stroke") == Some(colour)).flat_map(points).collect()
}
