"""FMUs and systems as other tools see them: checks, trials, containers, SSP packages, the contract."""
