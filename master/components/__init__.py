"""Components of a scene: FMUs by fmpy and their twins in process, behind one interface."""
