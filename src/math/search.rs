/// The golden ratio's fraction: it sections intervals for their minimum, and its multiples never come close to a period.
pub const GOLDEN: f64 = 0.618_033_988_749_894_9;
