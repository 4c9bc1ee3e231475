//! Hash FNV-1a, 64 bits: of layouts, tables and files that two programs must have alike.

/// Hash of nothing, with which every other one begins.
pub const FNV1A: u64 = 0xcbf2_9ce4_8422_2325;

/// Hash of these bytes behind those that `hash` is of.
pub fn fnv1a(hash: u64, bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(hash, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published test vectors.
    #[test]
    fn hash_of_known_strings() {
        let hash = |text: &str| fnv1a(FNV1A, text.bytes());
        assert_eq!(hash(""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(hash("a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(hash("foobar"), 0x8594_4171_f739_67e8);
        assert_eq!(fnv1a(hash("foo"), *b"bar"), hash("foobar"));
    }
}
