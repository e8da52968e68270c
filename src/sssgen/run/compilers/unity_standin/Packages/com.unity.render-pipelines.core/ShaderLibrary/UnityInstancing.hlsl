// Stand-in (see the README above): one object at a time and one eye, so instancing and stereo leave nothing behind.
#ifndef SSSGEN_STANDIN_INSTANCING
#define SSSGEN_STANDIN_INSTANCING

#define UNITY_VERTEX_INPUT_INSTANCE_ID
#define UNITY_VERTEX_OUTPUT_STEREO
#define UNITY_SETUP_INSTANCE_ID(input)
#define UNITY_TRANSFER_INSTANCE_ID(input, output)
#define UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output)
#define UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input)

#endif
