"""Generator of the scenes in scenes/: meshes, textures, a sky and scene files, from the standard library alone.

Run by scripts/generate-scenes. Lengths are metres, y is up, angles are degrees, colours are linear RGB unless a name
says sRGB. The same parameters give the same bytes everywhere: random numbers come from fixed seeds, all numbers are
rounded before they are written, and nothing depends on the time, the platform or the order of a hash table.
"""
