"""The chapters of a report on a run: functions of a `Subject`, which return what a template names."""
