//! A small check that a text is well-formed XML of the kind the plots write.

/// Panics with the reason unless elements nest, attributes are quoted, and entities are known.
pub(crate) fn assert_well_formed(svg: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = svg;
    while let Some(start) = rest.find('<') {
        assert_entities(&rest[..start]);
        let end = start + rest[start..].find('>').expect("tag without end");
        let tag = &rest[start + 1..end];
        rest = &rest[end + 1..];
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "closing tag out of order");
            continue;
        }
        let name = tag.split([' ', '/']).next().unwrap();
        assert_attributes(tag[name.len()..].trim_end_matches('/'));
        if !tag.ends_with('/') {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "unclosed: {open:?}");
    assert!(rest.trim().is_empty());
    for word in ["NaN", "inf\"", "inf ", "--"] {
        assert!(!svg.contains(word), "{word:?} in the drawing");
    }
}

fn assert_entities(text: &str) {
    for (at, _) in text.match_indices('&') {
        let known = ["&amp;", "&lt;", "&gt;", "&quot;"]
            .iter()
            .any(|entity| text[at..].starts_with(entity));
        assert!(known, "bare ampersand in {text:?}");
    }
    assert!(
        !text.contains(|c: char| c.is_control() && c != '\n'),
        "control character in {text:?}"
    );
}

/// `name="value"` pairs, each name once.
fn assert_attributes(mut text: &str) {
    let mut names: Vec<&str> = Vec::new();
    loop {
        text = text.trim_start();
        if text.is_empty() {
            return;
        }
        let (name, rest) = text.split_once("=\"").expect("attribute without value");
        let (value, rest) = rest.split_once('"').expect("attribute without end");
        assert!(
            name.chars()
                .all(|c| c.is_ascii_alphanumeric() || c == '-' || c == ':'),
            "attribute {name:?}"
        );
        assert!(!names.contains(&name), "attribute {name} twice");
        names.push(name);
        assert_entities(value);
        text = rest;
    }
}

/// Texts of all elements of one name, without markup.
pub(crate) fn texts(svg: &str, element: &str) -> Vec<String> {
    let open = format!("<{element}");
    svg.split(&open)
        .skip(1)
        .filter(|part| part.starts_with([' ', '>']))
        .map(|part| {
            let inside = part
                .split_once('>')
                .unwrap()
                .1
                .split(&format!("</{element}>"))
                .next()
                .unwrap();
            let mut text = String::new();
            let mut depth = 0;
            for c in inside.chars() {
                match c {
                    '<' => depth += 1,
                    '>' => depth -= 1,
                    c if depth == 0 => text.push(c),
                    _ => {}
                }
            }
            text
        })
        .collect()
}

/// Part of the drawing inside groups of a class (groups of series and grids hold no groups).
pub(crate) fn groups<'a>(svg: &'a str, class: &str) -> Vec<&'a str> {
    let open = format!("<g class=\"{class}\">");
    svg.split(open.as_str())
        .skip(1)
        .map(|part| part.split("</g>").next().unwrap())
        .collect()
}

/// Coordinates of the points of all paths in a part of a drawing.
pub(crate) fn path_points(part: &str) -> Vec<(f64, f64)> {
    let data = part
        .split("<path d=\"")
        .skip(1)
        .map(|part| part.split('"').next().unwrap());
    data.flat_map(|path| {
        let words = path.split(['M', 'L', ' ']).filter(|word| !word.is_empty());
        let numbers: Vec<f64> = words.map(|word| word.parse().unwrap()).collect();
        numbers
            .chunks(2)
            .map(|pair| (pair[0], pair[1]))
            .collect::<Vec<_>>()
    })
    .collect()
}

/// Largest distance in height between two curves drawn over the same abscissae.
pub(crate) fn apart(a: &[(f64, f64)], b: &[(f64, f64)]) -> f64 {
    let height = |x: f64| {
        let pair = b
            .windows(2)
            .find(|pair| pair[0].0 <= x && x <= pair[1].0)
            .expect("same abscissae");
        let part = (x - pair[0].0) / (pair[1].0 - pair[0].0);
        pair[0].1 + part * (pair[1].1 - pair[0].1)
    };
    a.iter().map(|(x, y)| (y - height(*x)).abs()).fold(0.0, f64::max)
}
