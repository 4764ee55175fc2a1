//! What stands before the pixels of a JPEG file: how many components, how they are coded, and whether the file has an end. The decoder
//! is lenient: it turns four inks into colours and fills what is cut short with grey, and numbers of a material are neither.
//!
//! Source: ITU-T T.81 (1992), Annex B.

/// Its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    /// Components of a pixel.
    pub(super) components: u8,
    /// Coefficients of a pixel that are kept until the last scan; 0 where rows are decoded one after the other.
    pub(super) kept: f64,
}

/// The frame of a file.
///
/// # Errors
/// What is wrong with it, in words.
pub(super) fn frame(bytes: &[u8]) -> Result<Frame, &'static str> {
    const CUT: &str = "cut short: it has no end of image";
    let mut frame = None;
    let mut at = 2;
    loop {
        let Some([0xff, marker]) = bytes.get(at..at + 2) else { return Err(CUT) };
        let marker = *marker;
        // fill bytes, and markers without a segment
        if marker == 0xff {
            at += 1;
            continue;
        }
        if matches!(marker, 0x01 | 0xd0..=0xd8) {
            at += 2;
            continue;
        }
        let Some([high, low]) = bytes.get(at + 2..at + 4) else { return Err(CUT) };
        let length = usize::from(u16::from_be_bytes([*high, *low]));
        let Some(segment) = bytes.get(at + 4..at + 2 + length.max(2)) else { return Err(CUT) };
        at += 2 + length.max(2);
        match marker {
            // start of a frame; C4, C8 and CC are tables
            0xc0..=0xcf if ![0xc4, 0xc8, 0xcc].contains(&marker) => frame = Some(start(marker, segment)?),
            // coded data: 0xff is followed by 0 there, so that a marker is one
            0xda => break,
            0xd9 => return Err("no image before its end"),
            _ => {}
        }
    }
    let rest = bytes.get(at..).unwrap_or_default();
    if !rest.windows(2).any(|pair| pair == [0xff, 0xd9]) {
        return Err(CUT);
    }
    frame.ok_or("no frame before its data")
}

fn start(marker: u8, segment: &[u8]) -> Result<Frame, &'static str> {
    let [_, _, _, _, _, components, of @ ..] = segment else { return Err("its frame is cut short") };
    match components {
        1..=3 => {}
        4 => return Err("four components (CMYK or YCCK): numbers are in grey or RGB"),
        _ => return Err("its number of components is none of 1, 3 and 4"),
    }
    // blocks of a component in a unit, across and down
    let factors: Vec<f64> = of.chunks_exact(3).map(|c| f64::from((c[1] >> 4) * (c[1] & 15))).collect();
    let most = factors.iter().copied().fold(1.0, f64::max);
    let progressive = marker != 0xc0 && marker != 0xc1;
    let kept = if progressive { factors.iter().map(|f| f / most).sum() } else { 0.0 };
    Ok(Frame { components: *components, kept })
}
