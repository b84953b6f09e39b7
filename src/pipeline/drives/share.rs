//! How one supply is shared by drives, period by period.
//!
//! Each drive has what it cannot do without; the rest goes to those that want more, in equal
//! parts, and what one does not want to the others. Since a drive that keeps to its share cannot
//! need more than it in the next period, the sum never exceeds the supply.

use super::drive::Drive;

/// The shares of drives of one converter, W; `supply_w` is what is left for them. None may take
/// more than it has: where the supply does not cover what they cannot do without, that is what
/// they get.
pub(super) fn shares(drives: &[&Drive], supply_w: f64) -> Vec<f64> {
    let committed: Vec<f64> = drives.iter().map(|drive| drive.committed_w()).collect();
    let wanted: Vec<f64> = drives.iter().map(|drive| drive.wanted_w()).collect();
    divided(&committed, &wanted, supply_w)
}

/// What each gets that cannot do without the first and wants no more than the second.
fn divided(committed: &[f64], wanted: &[f64], supply: f64) -> Vec<f64> {
    let mut shares = committed.to_vec();
    let mut rest = supply - shares.iter().sum::<f64>();
    let mut open: Vec<usize> = (0..shares.len())
        .filter(|index| wanted[*index] > committed[*index])
        .collect();
    while rest > 0.0 && !open.is_empty() {
        let part = rest / open.len() as f64;
        let least = open
            .iter()
            .map(|index| wanted[*index] - shares[*index])
            .fold(part, f64::min);
        for index in &open {
            shares[*index] += least;
        }
        if least >= part {
            break;
        }
        rest -= least * open.len() as f64;
        open.retain(|index| wanted[*index] - shares[*index] > least * 1e-12);
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::divided;

    #[test]
    fn what_one_does_not_want_goes_to_the_others() {
        assert_eq!(
            divided(&[100.0, 0.0, 50.0], &[100.0, 30.0, 900.0], 400.0),
            [100.0, 30.0, 270.0]
        );
        assert_eq!(divided(&[10.0, 10.0], &[500.0, 500.0], 100.0), [50.0, 50.0]);
        assert_eq!(divided(&[10.0, 10.0], &[30.0, 30.0], 100.0), [30.0, 30.0]);
        // More than there is: nobody gets more than it cannot do without.
        assert_eq!(divided(&[70.0, 60.0], &[90.0, 90.0], 100.0), [70.0, 60.0]);
    }
}
