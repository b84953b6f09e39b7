-- What the lines of all runs come to:
--
--     duckdb < totals.sql
CREATE VIEW programs AS SELECT * FROM read_json_auto('results/*.jsonl', union_by_name = true);

-- Files that hold only subprograms are no programs: nothing of them was looked at.

SELECT
    count(*) FILTER (WHERE NOT only_subprograms) AS programs,
    count(*) FILTER (WHERE fits AND NOT only_subprograms) AS fit,
    count(*) FILTER (WHERE error IS NULL AND NOT fits) AS do_not,
    count(*) FILTER (WHERE error IS NOT NULL) AS not_read,
    round(sum(duration_s) / 3600, 2) AS hours,
    round(sum(energy_j) / 3.6e6, 3) AS energy_kwh
FROM programs;

-- The largest peaks.
SELECT program, peak_w, peak_line, unfit_count FROM programs
WHERE error IS NULL ORDER BY peak_w DESC, program LIMIT 20;
