//! The binary format of a response to a page: JSON, followed by the table's columns.
//!
//! The first four bytes are the length of the JSON. The JSON is padded with blanks so that the numbers after it begin at a multiple of
//! eight bytes. The columns follow one after the other. All numbers are little-endian. `page/src/data/live.ts` reads this format.

use serde_json::Value;

/// Encodes a response.
#[must_use]
pub(super) fn encode(json: &Value, columns: &[Vec<f64>]) -> Vec<u8> {
    let mut text = json.to_string().into_bytes();
    while !(4 + text.len()).is_multiple_of(8) {
        text.push(b' ');
    }
    let numbers: usize = columns.iter().map(Vec::len).sum();
    let mut bytes = Vec::with_capacity(4 + text.len() + 8 * numbers);
    bytes.extend((text.len() as u32).to_le_bytes());
    bytes.extend(text);
    for value in columns.iter().flatten() {
        bytes.extend(value.to_le_bytes());
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::encode;
    use serde_json::json;

    #[test]
    fn numbers_are_aligned_to_eight_bytes() {
        for text in ["", "a", "ab", "abcdefg"] {
            let json = json!({ "a": text });
            let bytes = encode(&json, &[vec![1.5, -0.0], vec![f64::NAN, 2.0]]);
            let length = u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as usize;
            assert_eq!((4 + length) % 8, 0);
            assert_eq!(serde_json::from_slice::<serde_json::Value>(&bytes[4..4 + length]).ok(), Some(json));
            let numbers: Vec<u64> = bytes[4 + length..]
                .chunks(8)
                .map(|eight| u64::from_le_bytes(eight.try_into().expect("eight bytes")))
                .collect();
            assert_eq!(numbers, [1.5, -0.0, f64::NAN, 2.0].map(f64::to_bits));
        }
    }
}
