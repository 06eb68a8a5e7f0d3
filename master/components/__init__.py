"""What a scene is made of: FMUs by fmpy and their twins in process, behind one interface."""
