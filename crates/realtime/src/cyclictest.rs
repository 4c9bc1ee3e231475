//! `cyclictest` of rt-tests: what the machine gives to anybody.

use std::process::Command;

/// Runs `cyclictest` on `core`, or any, at `priority` with a period of 1 ms for so many seconds: lateness \[us\] p50, p99, p99.9,
/// max. It shows what the machine gives to anybody.
///
/// # Errors
/// It is not installed, or may not run.
pub fn cyclictest(core: Option<usize>, priority: u8, seconds: u64) -> Result<[u64; 4], String> {
    let output = Command::new("cyclictest")
        .args(["-q", "-m", "-t", "1", "-i", "1000", "-h", "20000"])
        .args(["-p", &priority.to_string(), "-D", &seconds.to_string()])
        .args(core.map(|core| format!("-a{core}")))
        .output()
        .map_err(|e| format!("cyclictest: {e} (Debian and Ubuntu: apt install rt-tests)"))?;
    if !output.status.success() {
        return Err(format!("cyclictest: {}", String::from_utf8_lossy(&output.stderr).trim()));
    }
    Ok(percentiles(&String::from_utf8_lossy(&output.stdout)))
}

/// p50, p99, p99.9 and the maximum of a histogram of cyclictest: lines of microseconds and counts, then comments.
fn percentiles(histogram: &str) -> [u64; 4] {
    let rows: Vec<(u64, u64)> = histogram
        .lines()
        .filter_map(|line| {
            let mut words = line.split_whitespace();
            Some((words.next()?.parse().ok()?, words.next()?.parse().ok()?))
        })
        .collect();
    let max = histogram.lines().find_map(|line| line.strip_prefix("# Max Latencies:"));
    let max = max.and_then(|text| text.trim().parse().ok()).unwrap_or(0);
    let total: u64 = rows.iter().map(|(_, count)| count).sum();
    let at = |permille: u64| {
        let rank = (total * permille).div_ceil(1000).max(1);
        let mut seen = 0;
        let found = rows.iter().find(|(_, count)| {
            seen += count;
            seen >= rank
        });
        found.map_or(max, |(us, _)| *us)
    };
    [at(500), at(990), at(999), max]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_of_a_histogram_of_cyclictest() {
        let text = "# /dev/cpu_dma_latency set to 0us\n# Histogram\n000001 000000\n000002 000980\n000003 000015\n\
                    000090 000004\n# Total: 000000999\n# Min Latencies: 00002\n# Max Latencies: 25000\n\
                    # Histogram Overflows: 00001\n";
        assert_eq!(percentiles(text), [2, 3, 90, 25000]);
    }
}
