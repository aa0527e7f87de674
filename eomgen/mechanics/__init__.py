"""The mechanics, written once over two algebras: where things move, and one formalism a file."""
