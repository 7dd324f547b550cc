"""
The blind benchmark: rigs that are not the model, their labels apart, and the score.

The rigs have laws, an integrator and sensors of their own and share none with the catalogue of
effects or with the model's kernel. Labels are written beside the cases, never into them, and only
the scorer reads them.
"""
