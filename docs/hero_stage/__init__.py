"""Hero pictures: bodies of the emitted shaders in three.js with surroundings, beside the same scene path traced."""
