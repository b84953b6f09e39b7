//! `gwatt plan` from outside.

use crate::shop::Shop;
use insta::assert_snapshot;

fn shop(schedule: &str) -> Shop {
    let shop = Shop::mill("iso", "peak_power_w = 900", "", "");
    shop.put("drives.csv", schedule);
    shop
}

#[test]
fn a_run_is_summed_up_and_written() {
    let shop = shop("time_s,drive,position_mm\n0,X,200\n0,Y,200\n");
    let (code, text, errors) = shop.run("plan drives.csv --period-ms 200");
    assert_eq!(code, 0, "{errors}");
    assert_snapshot!(errors, @r"
    gwatt: note: peaks are those at the ends of periods, which are 200 ms apart; between them the supply is held too
    drives.csv: within the supply: 0.60 s; peak 225 W of 900 W, 0 W fed back
      line 2  X → 200 mm in 0.60 s  peak 62.5 W
      line 3  Y → 200 mm in 0.60 s  peak 62.5 W
    ");
    assert_snapshot!(text.replace('\r', ""), @r"
    time_s,power_w,limit_w,fed_back_w,x_position_mm,x_speed_mm_min,x_accel_mm_s2,x_jerk_mm_s3,x_power_w,y_position_mm,y_speed_mm_min,y_accel_mm_s2,y_jerk_mm_s3,y_power_w
    0,100,900,0,0,0,0,0,0,0,0,0,0,0
    0.2,225,900,0,58.32208459992103,30000,0,0,62.5,58.32208459992103,30000,0,0,62.5
    0.4,225,900,0,158.32208459992103,30000,0,0,62.5,158.32208459992103,30000,0,0,62.5
    0.6,100,900,0,200,0,0,0,0,200,0,0,0,0
    ");
}

#[test]
fn what_exceeds_the_supply_is_status_one() {
    let shop = shop("time_s,drive,speed_mm_min,power_w\n0,X,30000,\n1,all,,120\n1.5,X,0,\n");
    let (code, _, errors) = shop.run("plan drives.csv");
    assert_eq!(code, 1, "{errors}");
    assert!(
        errors.contains("exceeds the supply from 1.00 s on"),
        "{errors}"
    );
}

#[test]
fn errors_name_their_line() {
    let cases = [
        ("", "the schedule has no row for a drive"),
        (
            "time_s,drive,position_mm\n",
            "the schedule has no row for a drive",
        ),
        ("time_s,position_mm\n0,5\n", "there is no column `drive`"),
        ("time_s,drive,x\n0,X,5\n", "unknown column `x`"),
        (
            "time_s,drive,time_s\n0,X,5\n",
            "column `time_s` is there twice",
        ),
        (
            "time_s,drive,position_mm\n0,A,5\n",
            "the machine has no drive `A`",
        ),
        (
            "time_s,drive,position_mm\n0,spindle,5\n",
            "the machine has no drive `spindle`",
        ),
        (
            "time_s,drive,position_deg\n0,X,5\n",
            "`position_deg` does not go with this drive",
        ),
        (
            "time_s,drive,position_mm\n0,X,five\n",
            "`five` is not a number",
        ),
        ("time_s,drive,position_mm\n,X,5\n", "`time_s` is missing"),
        (
            "time_s,drive,position_mm\n0,X,5,6\n",
            "more values than columns",
        ),
        (
            "time_s,drive,position_mm\n-1,X,5\n",
            "`time_s` must be greater than 0",
        ),
        (
            "time_s,drive,position_mm\n1,X,5\n0.5,Y,5\n",
            "time 0.5 s comes after 1 s",
        ),
        (
            "time_s,drive,position_mm\n1,X,5\n1,X,6\n",
            "a second row for this drive at 1 s",
        ),
        (
            "time_s,drive,speed_mm_min\n0,X,99999\n",
            "the drive does not reach 99999",
        ),
        (
            "time_s,drive,accel_mm_s2\n0,X,0\n",
            "`accel_mm_s2` must be greater than 0",
        ),
        (
            "time_s,drive,position_mm,speed_mm_min\n0,X,5,-100\n",
            "the largest speed on the way to a position must be greater than 0",
        ),
        (
            "time_s,drive,speed_mm_min,power_w\n0,X,30000,101\n0,all,,110\n",
            "what the supply leaves does not carry this drive to its target",
        ),
    ];
    for (schedule, message) in cases {
        let shop = shop(schedule);
        let (code, text, errors) = shop.run("plan drives.csv -o out.csv");
        assert_eq!((code, text.as_str()), (2, ""), "{schedule}: {errors}");
        assert!(errors.contains(message), "{schedule}: {errors}");
        assert!(!shop.0.path().join("out.csv").exists(), "{schedule}");
    }
}
