//! What a `data:` URI holds (RFC 2397).

/// Why a `data:` URI cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DataError {
    /// Another scheme, or no comma.
    #[error("no `data:` URI")]
    Form,
    /// Text that is no base64.
    #[error("base64: byte {at} of the data is none of its letters, or the last group is cut")]
    Base64 {
        /// Offset behind the comma.
        at: usize,
    },
}

/// The bytes of a `data:` URI: base64 if it says so, else text with percent escapes.
///
/// # Errors
/// [`DataError`].
pub fn decode(uri: &str) -> Result<Vec<u8>, DataError> {
    let (scheme, rest) = uri.split_at_checked(5).ok_or(DataError::Form)?;
    let (head, data) = rest.split_once(',').ok_or(DataError::Form)?;
    if !scheme.eq_ignore_ascii_case("data:") {
        return Err(DataError::Form);
    }
    let encoded = head.rsplit(';').next().is_some_and(|last| last.eq_ignore_ascii_case("base64"));
    let bytes = unescape(data);
    if encoded && head.contains(';') { base64(&bytes) } else { Ok(bytes) }
}

fn unescape(text: &str) -> Vec<u8> {
    let bytes = text.as_bytes();
    let digit =
        |i: usize| bytes.get(i).and_then(|b| char::from(*b).to_digit(16)).and_then(|d| u8::try_from(d).ok());
    let mut out = Vec::with_capacity(bytes.len());
    let mut i = 0;
    while let Some(&byte) = bytes.get(i) {
        match (byte, digit(i + 1), digit(i + 2)) {
            (b'%', Some(high), Some(low)) => {
                out.push(16 * high + low);
                i += 3;
            }
            _ => {
                out.push(byte);
                i += 1;
            }
        }
    }
    out
}

/// RFC 4648 §4; the padding may be missing.
fn base64(text: &[u8]) -> Result<Vec<u8>, DataError> {
    let end = text.iter().rposition(|b| *b != b'=').map_or(0, |i| i + 1);
    let text = &text[..end];
    let mut out = Vec::with_capacity(text.len() / 4 * 3 + 2);
    let (mut bits, mut count) = (0_u32, 0);
    for (at, byte) in text.iter().enumerate() {
        let value = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return Err(DataError::Base64 { at }),
        };
        bits = bits << 6 | u32::from(value);
        count += 6;
        if count >= 8 {
            count -= 8;
            out.push(u8::try_from(bits >> count & 0xff).unwrap_or(0));
        }
    }
    // a single letter holds six bits, which are no byte
    if text.len() % 4 == 1 { Err(DataError::Base64 { at: text.len() }) } else { Ok(out) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "test")]
    use super::*;

    /// The vectors of RFC 4648 §10.
    #[test]
    fn vectors_of_the_standard() {
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9vYmFy", "foobar"),
        ] {
            assert_eq!(decode(&format!("data:;base64,{text}")).unwrap(), bytes.as_bytes());
            assert_eq!(
                decode(&format!("DATA:image/png;BASE64,{}", text.trim_end_matches('='))).unwrap(),
                bytes.as_bytes()
            );
        }
        assert_eq!(decode("data:,a%20b%2").unwrap(), b"a b%2");
        assert_eq!(decode("data:;base64,Zm9vY"), Err(DataError::Base64 { at: 5 }));
        assert_eq!(decode("data:;base64,Zm-v"), Err(DataError::Base64 { at: 2 }));
        assert_eq!(decode("x.png"), Err(DataError::Form));
    }
}
