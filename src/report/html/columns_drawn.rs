//! Long programs as a still picture: what stands in one column of it becomes one.

use super::shares::Span;

/// Columns of a picture: more than its points, so that no step is seen.
const COLUMNS: f64 = 1800.0;

/// Peaks over time: from, to, drawn, fed back.
pub(super) type Peaks = Vec<[f64; 4]>;

/// The peaks of each column, no lower than those in it.
pub(super) fn peaks(peaks: Peaks, most_s: f64) -> Peaks {
    if (peaks.len() as f64) <= COLUMNS {
        return peaks;
    }
    let mut thinned: Peaks = Vec::new();
    let mut last = None;
    for [from_s, to_s, drawn_w, back_w] in peaks {
        let column = column(from_s, most_s);
        match thinned.last_mut() {
            Some(own) if last == Some(column) && drawn_w.is_finite() && own[2].is_finite() => {
                own[1] = own[1].max(to_s);
                own[2] = own[2].max(drawn_w);
                own[3] = own[3].max(back_w);
            }
            _ => thinned.push([from_s, to_s, drawn_w, back_w]),
        }
        last = Some(column);
    }
    thinned
}

/// The spans of each column: the moment in it at which most is drawn, and that at which most is
/// fed back.
pub(super) fn spans(spans: &[Span], most_s: f64) -> Vec<Span> {
    if (spans.len() as f64) <= COLUMNS {
        return spans.to_vec();
    }
    let mut thinned: Vec<Span> = Vec::new();
    let mut last = None;
    for span in spans {
        let column = column(span.from_s, most_s);
        match thinned.last_mut().filter(|_| last == Some(column)) {
            Some(own) => own.join(span),
            None => thinned.push(span.clone()),
        }
        last = Some(column);
    }
    thinned
}

/// The column in which a time stands.
fn column(time_s: f64, most_s: f64) -> u32 {
    (time_s / most_s * COLUMNS) as u32
}

#[cfg(test)]
mod tests {
    use super::peaks;

    /// The largest of 100,000 blocks stands in the picture as it is, on 1,801 columns.
    #[test]
    fn no_peak_is_lost() {
        let block = |index: u32| {
            let at = f64::from(index);
            let drawn_w = if index == 70_003 {
                9000.0
            } else {
                f64::from(index % 7)
            };
            let back_w = if index == 123 { 800.0 } else { 0.0 };
            [at, at + 1.0, drawn_w, back_w]
        };
        let all: Vec<_> = (0..100_000).map(block).collect();
        let drawn = peaks(all.clone(), 100_000.0);
        assert!((1700..=1801).contains(&drawn.len()), "{}", drawn.len());
        let most = |list: &[[f64; 4]], which: usize| {
            list.iter().map(|peak| peak[which]).fold(0.0, f64::max)
        };
        assert_eq!([most(&drawn, 2), most(&drawn, 3)], [9000.0, 800.0]);
        assert_eq!(most(&drawn, 1), 100_000.0);
        let few = all[..50].to_vec();
        assert_eq!(peaks(few.clone(), 50.0), few);
    }
}
