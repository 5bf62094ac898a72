"""The second deformer: layered soft tissue over a skull, moved by 23 muscles (Zhang, Prakash and Sung).

Inside, lengths are millimetres and positions float64 unless a name says otherwise.
"""
