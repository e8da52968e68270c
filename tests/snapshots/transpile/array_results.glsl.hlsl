error: a function cannot return an array for this target: give it an out parameter (hlsl)
  --> array_results.glsl:4:10
 4 | float[3] thirds(float x) {
   |          ^^^^^^
