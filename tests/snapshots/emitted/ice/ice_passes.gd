# Draws what ice needs before it. Add a node of this type below the body. Made by sssgen for Godot 4.
class_name IcePasses
extends "sssgen_passes.gd"

func needed() -> Dictionary: return {}
func passes() -> Array[Dictionary]:
	return [
		{"empty": "far", "layers": ["entry 1", "other 1"], "lights": "occluded_lights", "name": "occluders", "seen_from": "each shadow", "size": null, "texture": "occluder_map", "views": ["occluder_matrix", "occluder_matrix_2", "occluder_matrix_3", "occluder_matrix_4"]},
	]
