"""The chapters of a report on a run: functions of a `Subject` that return blocks, or raise Absent."""
