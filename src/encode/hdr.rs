//! Radiance HDR: three channels as RGBE, run-length encoded by component.
//!
//! A viewer's format: 8 bits of mantissa for the largest channel of a texel and fewer for the others. Fewer than three
//! channels are filled with 0. The provenance is the line `brdfbake=...` of the header. Rows run from the top (`-Y h +X
//! w`). Scan lines of 8 to 32767 pixels are run-length encoded by component, others are flat; both are the format's rule.
//!
//! Source: Ward, "Real Pixels", Graphics Gems II (1991); the format's reference is `color.c` of Radiance.

use super::read::{Claim, Image, MAX_SAMPLES, ReadError};
use super::{EncodeError, EncodeInput, Encoder, Shape, Storage, texels};
use crate::cancel::Cancel;
use crate::grid::provenance::ATTRIBUTE;

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Hdr;

const FORMAT: &str = "hdr";
const MAGIC: &[u8] = b"#?RADIANCE";
const OTHER: &[u8] = b"#?RGBE";

/// Longest header that is read.
const MAX_HEADER: usize = 1 << 24;

impl Encoder for Hdr {
    fn id(&self) -> &'static str {
        FORMAT
    }

    fn extension(&self) -> &'static str {
        "hdr"
    }

    fn media_type(&self) -> &'static str {
        "image/vnd.radiance"
    }

    fn storages(&self) -> &'static [Storage] {
        &[Storage::Rgbe]
    }

    fn most_channels(&self) -> usize {
        3
    }

    fn components(&self, _: &Shape<'_>) -> usize {
        3
    }

    fn colours(&self, _count: usize) -> &'static [&'static str] {
        super::COLOURS
    }

    fn magic(&self) -> &'static [&'static [u8]] {
        &[MAGIC, OTHER]
    }

    fn read(&self, bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
        read(bytes, cancel)
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self)?;
        let [width, height] = input.size();
        let pixels = texels::pack(input, 3)?;
        let mut out = MAGIC.to_vec();
        out.extend(b"\nFORMAT=32-bit_rle_rgbe\n");
        // a line ends the value: JSON text as it is written here has none, a caller's might
        let text = input.label.provenance_json.replace(['\n', '\r'], " ");
        out.extend(format!("{ATTRIBUTE}={text}\n\n-Y {height} +X {width}\n").into_bytes());
        for row in pixels.chunks_exact(width * 4) {
            input.cancel.check()?;
            match u16::try_from(width) {
                Ok(w) if (8..0x8000).contains(&w) => {
                    out.extend([2, 2]);
                    out.extend(w.to_be_bytes());
                    (0..4).for_each(|c| runs(row.iter().skip(c).step_by(4).copied().collect(), &mut out));
                }
                _ => out.extend(row),
            }
        }
        Ok(out)
    }
}

/// One component of a scan line: runs of at least four equal bytes as `128 + length, byte`, others as `length, bytes`.
fn runs(line: Vec<u8>, out: &mut Vec<u8>) {
    let run = |at: usize| line[at..].iter().take(127).take_while(|b| **b == line[at]).count();
    let mut at = 0;
    while at < line.len() {
        let length = run(at);
        if length >= 4 {
            out.extend([128 + u8::try_from(length).unwrap_or(0), line[at]]);
            at += length;
            continue;
        }
        let start = at;
        while at < line.len() && at - start < 128 && run(at) < 4 {
            at += 1;
        }
        out.push(u8::try_from(at - start).unwrap_or(0));
        out.extend(&line[start..at]);
    }
}

fn fault(fault: impl Into<String>) -> ReadError {
    ReadError::Fault { format: FORMAT, fault: fault.into() }
}

fn read(bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
    let head = &bytes[..bytes.len().min(MAX_HEADER)];
    let mut lines = head.split(|b| *b == b'\n');
    let mut used = 0;
    let mut text = None;
    for line in lines.by_ref() {
        used += line.len() + 1;
        if let Some(value) = line.strip_prefix(format!("{ATTRIBUTE}=").as_bytes()) {
            text = Some(String::from_utf8_lossy(value).into_owned());
        }
        if line == b"FORMAT=32-bit_rle_xyze" {
            return Err(fault("XYZE pixels are not supported"));
        }
        if line.is_empty() {
            break;
        }
    }
    let line = lines.next().ok_or_else(|| fault("the header has no end"))?;
    used += line.len() + 1;
    let (width, height) = size(line)?;
    if width.saturating_mul(height).saturating_mul(3) > MAX_SAMPLES {
        return Err(ReadError::Samples { format: FORMAT, width, height });
    }
    let pixels = pixels(bytes.get(used..).unwrap_or_default(), width, height, cancel)?;
    let provenance = text.map(Claim::parse);
    let channels = texels::finish(
        texels::unpack(&pixels, Storage::Rgbe, 3, [width, height, 1], cancel),
        provenance.as_ref(),
    );
    Ok(Image { format: FORMAT, width, height, channels, provenance, warnings: Vec::new() })
}

/// `-Y height +X width`, the only order that is read.
fn size(line: &[u8]) -> Result<(usize, usize), ReadError> {
    let text = String::from_utf8_lossy(&line[..line.len().min(100)]).into_owned();
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    let number = |s: &str| s.parse::<usize>().ok().filter(|n| *n > 0);
    match words[..] {
        ["-Y", h, "+X", w] => number(w).zip(number(h)),
        _ => None,
    }
    .ok_or_else(|| fault(format!("the size `{text}` is not of the form -Y height +X width")))
}

/// Four bytes a pixel. Memory grows with what the file holds, not with what its header tells.
fn pixels(data: &[u8], width: usize, height: usize, cancel: &Cancel) -> Result<Vec<u8>, ReadError> {
    let cut = || fault("the pixels are cut short");
    let mut out = Vec::new();
    let mut at = 0;
    for _ in 0..height {
        cancel.check()?;
        let head = data.get(at..at + 4).ok_or_else(cut)?;
        let coded = head[0] == 2 && head[1] == 2 && usize::from(head[2]) << 8 | usize::from(head[3]) == width;
        if coded && (8..0x8000).contains(&width) {
            at += 4;
            let line = coded_line(data, &mut at, width).ok_or_else(cut)?;
            out.extend((0..width).flat_map(|x| [0, 1, 2, 3].map(|c| line[c * width + x])));
        } else {
            if data[at..at + 3] == [1, 1, 1] {
                return Err(fault("the run lengths of old files are not supported"));
            }
            out.extend(data.get(at..at + width * 4).ok_or_else(cut)?);
            at += width * 4;
        }
    }
    if at < data.len() {
        return Err(fault(format!("{} bytes behind the last pixel", data.len() - at)));
    }
    Ok(out)
}

/// The four components of a scan line, one after the other; none if the data end early or a run is too long.
fn coded_line(data: &[u8], at: &mut usize, width: usize) -> Option<Vec<u8>> {
    let mut line = Vec::with_capacity(4 * width);
    for c in 1..=4 {
        while line.len() < c * width {
            let count = usize::from(*data.get(*at)?);
            let (length, used) = if count > 128 { (count - 128, 1) } else { (count, count) };
            let bytes = data.get(*at + 1..*at + 1 + used)?;
            if length == 0 || line.len() + length > c * width {
                return None;
            }
            if count > 128 {
                line.resize(line.len() + length, bytes[0])
            } else {
                line.extend(bytes)
            }
            *at += 1 + used;
        }
    }
    Some(line)
}
