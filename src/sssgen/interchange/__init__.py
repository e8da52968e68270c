"""Materials of other formats: glTF, MaterialX, Unity to materials of sssgen, and back to glTF."""
