//! What a `data:` URI holds (RFC 2397).

use data_url::DataUrl;

/// Why a `data:` URI cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DataError {
    /// Another scheme, or no comma.
    #[error("no `data:` URI")]
    Form,
    /// Text that is no base64.
    #[error("its data is no base64")]
    Base64,
}

/// The bytes of a `data:` URI: base64 if it says so, else text with percent escapes.
///
/// # Errors
/// [`DataError`].
pub fn decode(uri: &str) -> Result<Vec<u8>, DataError> {
    let url = DataUrl::process(uri).map_err(|_| DataError::Form)?;
    url.decode_to_vec().map(|(bytes, _)| bytes).map_err(|_| DataError::Base64)
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
        assert_eq!(decode("data:;base64,Zm9vY"), Err(DataError::Base64));
        assert_eq!(decode("data:;base64,Zm-v"), Err(DataError::Base64));
        assert_eq!(decode("x.png"), Err(DataError::Form));
    }
}
