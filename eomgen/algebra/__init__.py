"""Two algebras under one interface: the closed form for people, the graph for machines."""
