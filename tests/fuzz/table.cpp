// Any bytes as a table: what pongeye-bench scores, and what calibration is refined from.
#include "table.hpp"
#include "bytes_file.hpp"
#include "program.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	const BytesFile file(data, size);
	try {
		const pong::Table table(file.path());
		const size_t first = table.column("utime"), second = table.column("x");
		for (size_t row = 0; row < table.rows(); row++) {
			table.get(row, second);
			table.get_integer(row, first);
		}
	} catch (const pong::Failure &) {
		return 0; // one sentence: as it should be
	}
	return 0;
}
