"""Files into core objects: trees and wind records, one file a format."""
