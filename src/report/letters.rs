//! Letters as strokes, for pictures of pixels: capitals, digits and signs on a grid of 4 x 6.

/// Width of a letter with its gap, and height, in cells.
pub(super) const ADVANCE: f64 = 5.6;
pub(super) const HEIGHT: f64 = 6.0;

/// Points as pairs of digits, strokes apart; x to the right, y down. What has none is a gap.
fn glyph(c: char) -> &'static str {
    match c.to_ascii_uppercase() {
        'A' => "062046 1434",
        'B' => "00063645443303 3342413000",
        'C' => "4130100105163645",
        'D' => "00062644422000",
        'E' => "40000646 0333",
        'F' => "400006 0333",
        'G' => "41301001051636454323",
        'H' => "0006 4046 0343",
        'I' => "1030 2026 1636",
        'J' => "4045361605",
        'K' => "0006 400346",
        'L' => "000646",
        'M' => "0600234046",
        'N' => "06004640",
        'O' => "100105163645413010",
        'P' => "06003041423303",
        'Q' => "100105163645413010 2446",
        'R' => "06003041423303 2346",
        'S' => "413010010213334445361605",
        'T' => "0040 2026",
        'U' => "000516364540",
        'V' => "002640",
        'W' => "0016233640",
        'X' => "0046 4006",
        'Y' => "002340 2326",
        'Z' => "00400646",
        '0' => "100105163645413010 0541",
        '1' => "112026 1636",
        '2' => "01103041420646",
        '3' => "004023334445361605",
        '4' => "36300444",
        '5' => "400003334445361605",
        '6' => "413010010516364544331304",
        '7' => "004016",
        '8' => "100102133344453616050413 3342413010",
        '9' => "051636454130100102133342",
        '.' => "2526",
        ',' => "2517",
        '-' => "1333",
        '+' => "1333 2224",
        '/' => "0640",
        '(' => "30121436",
        ')' => "10323416",
        ':' => "2122 2526",
        ';' => "2122 2517",
        '=' => "1232 1434",
        '_' => "0646",
        '^' => "022042",
        '<' => "410345",
        '>' => "014305",
        '|' => "2026",
        '\'' => "2022",
        '[' => "30101636",
        ']' => "10303616",
        '%' => "0640 0112 3445",
        '*' => "1135 3115 2125",
        '#' => "1016 3036 0242 0444",
        '?' => "0110304132232425 2626",
        '!' => "2024 2626",
        '"' => "1012 3032",
        _ => "",
    }
}

/// Strokes of a text whose letters are `size` high, from the left end of its base line.
pub(super) fn strokes(text: &str, [x, y]: [f64; 2], size: f64) -> Vec<Vec<[f64; 2]>> {
    let cell = size / HEIGHT;
    let mut all = Vec::new();
    for (i, c) in text.chars().enumerate() {
        let left = x + i as f64 * ADVANCE * cell;
        for stroke in glyph(c).split(' ').filter(|s| !s.is_empty()) {
            let at = |pair: &[u8]| {
                let [a, b] = [0, 1].map(|k| pair.get(k).map_or(0.0, |d| f64::from(d.saturating_sub(b'0'))));
                [left + a * cell, y - (HEIGHT - b) * cell]
            };
            all.push(stroke.as_bytes().chunks(2).map(at).collect());
        }
    }
    all
}

/// Width of a text whose letters are `size` high.
pub(super) fn width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * ADVANCE * size / HEIGHT
}
