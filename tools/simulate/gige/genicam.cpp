#include "genicam.hpp"

#include <algorithm>

#include "program.hpp"

namespace gige
{

namespace
{

using pong::format;

std::string element(const char *tag, const std::string &content)
{
	return format("<%s>", tag) + content + format("</%s>", tag);
}

std::string named(const char *tag, const std::string &name, const std::string &content)
{
	return format("<%s Name=\"%s\" NameSpace=\"Standard\">", tag, name.c_str()) + content + format("</%s>\n", tag);
}

std::string whole(double number)
{
	return format("%.0f", number);
}

// The register behind a feature: IntReg, FloatReg or StringReg.
std::string register_node(const char *tag, const std::string &name, const Register &place)
{
	std::string content =
		element("Address", format("0x%x", place.address)) + element("Length", format("%u", place.length)) +
		element("AccessMode", place.access == Access::read ? "RO" : "RW") + element("pPort", "Device");
	if (place.kind != Kind::text)
		content += element("Cachable", "NoCache");
	if (place.kind != Kind::text && place.kind != Kind::real)
		content += element("Sign", "Unsigned");
	if (place.kind != Kind::text)
		content += element("Endianess", "BigEndian"); // the schema's spelling
	return named(tag, name, content);
}

std::string limits(const Register &place, const std::string &max)
{
	if (place.access == Access::read)
		return "";
	return element("Min", whole(place.min)) + max +
	       (place.step > 1 ? element("Inc", whole(place.step)) : std::string());
}

std::string integer_feature(const Register &place)
{
	const std::string name = place.name;
	if (!*place.max_of)
		return limits(place, element("Max", whole(place.max)));
	return limits(place, element("pMax", name + "Limit"));
}

std::string limit_node(const Register &place)
{
	return named("IntSwissKnife", std::string(place.name) + "Limit",
		     format("<pVariable Name=\"ALL\">%s</pVariable><pVariable Name=\"TAKEN\">%s</pVariable>",
			    place.max_of, place.max_less) +
			     element("Formula", "ALL - TAKEN"));
}

std::string entries(const Register &place)
{
	std::string all;
	for (const Entry &entry : place.entries)
		all += named("EnumEntry", entry.name, element("Value", whole(entry.value)));
	return all;
}

std::string feature(const Register &place)
{
	const std::string name = place.name, value = name + "Register";
	if (place.kind == Kind::text)
		return register_node("StringReg", name, place);
	const std::string content =
		(place.when == When::always ? "" : element("pIsLocked", "TLParamsLocked")) + element("pValue", value);
	switch (place.kind) {
	case Kind::real:
		return named("Float", name,
			     content + limits(place, element("Max", whole(place.max))) + element("Unit", place.unit)) +
		       register_node("FloatReg", value, place);
	case Kind::boolean:
		return named("Boolean", name, content + element("OnValue", "1") + element("OffValue", "0")) +
		       register_node("IntReg", value, place);
	case Kind::enumeration:
		return named("Enumeration", name, entries(place) + content) + register_node("IntReg", value, place);
	case Kind::command:
		return named("Command", name, content + element("CommandValue", whole(place.max))) +
		       register_node("IntReg", value, place);
	default:
		return named("Integer", name, content + integer_feature(place)) +
		       register_node("IntReg", value, place) + (*place.max_of ? limit_node(place) : std::string());
	}
}

// Two fields of one bootstrap register. GigE Vision counts bits from the most significant, 0.
std::string packet_size_features()
{
	const std::string place = element("Address", format("0x%x", at::stream_packet_size)) + element("Length", "4") +
				  element("AccessMode", "RW") + element("pPort", "Device") +
				  element("Cachable", "NoCache");
	return named("Integer", "GevSCPSPacketSize",
		     element("pIsLocked", "TLParamsLocked") + element("pValue", "GevSCPSPacketSizeRegister") +
			     element("Min", whole(gvsp::min_packet_size)) +
			     element("Max", whole(gvsp::max_packet_size)) +
			     element("Inc", whole(gvsp::packet_size_step))) +
	       named("MaskedIntReg", "GevSCPSPacketSizeRegister",
		     place + "<LSB>31</LSB><MSB>16</MSB><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>") +
	       named("Command", "GevSCPSFireTestPacket",
		     element("pValue", "GevSCPSFireTestPacketRegister") + element("CommandValue", "1")) +
	       named("MaskedIntReg", "GevSCPSFireTestPacketRegister",
		     place + "<Bit>0</Bit><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>");
}

struct ChunkFeature {
	const char *name;
	Chunk chunk;
	bool is_real;
	int length;
};

const ChunkFeature chunk_features[] = {
	{"ChunkFrameID", Chunk::frame_id, false, 4},          {"ChunkTimestamp", Chunk::timestamp, false, 8},
	{"ChunkExposureTime", Chunk::exposure_time, true, 4}, {"ChunkLineStatusAll", Chunk::line_status, false, 4},
	{"ChunkCounterValue", Chunk::counter, false, 4},
};

std::string chunk_feature(const ChunkFeature &chunk)
{
	const std::string name = chunk.name;
	std::string content = "<Address>0</Address>" + element("Length", format("%d", chunk.length)) +
			      element("AccessMode", "RO") + element("pPort", name + "Port");
	if (!chunk.is_real)
		content += element("Sign", "Unsigned");
	content += element("Endianess", "BigEndian");
	return named(chunk.is_real ? "Float" : "Integer", name, element("pValue", name + "Register")) +
	       named(chunk.is_real ? "FloatReg" : "IntReg", name + "Register", content) +
	       named("Port", name + "Port", element("ChunkID", format("%x", static_cast<uint32_t>(chunk.chunk))));
}

// The features of a category, in the table's order, and those that the table cannot tell.
std::vector<std::string> members(const std::vector<Register> &table, const std::string &category)
{
	std::vector<std::string> names;
	for (const Register &place : table)
		if (place.category == category)
			names.push_back(place.name);
	if (category == "TransportLayerControl")
		names.insert(names.end(), {"GevSCPSPacketSize", "GevSCPSFireTestPacket"});
	if (category == "ChunkDataControl")
		for (const ChunkFeature &chunk : chunk_features)
			names.push_back(chunk.name);
	return names;
}

std::string category_node(const std::string &name, const std::vector<std::string> &features)
{
	std::string content;
	for (const std::string &feature : features)
		content += element("pFeature", feature);
	return named("Category", name, content);
}

std::string category_tree(const std::vector<Register> &table)
{
	std::vector<std::string> categories;
	for (const Register &place : table)
		if (*place.category &&
		    std::find(categories.begin(), categories.end(), place.category) == categories.end())
			categories.push_back(place.category);
	std::string tree = category_node("Root", categories);
	for (const std::string &category : categories)
		tree += category_node(category, members(table, category));
	return tree;
}

} // namespace

std::string describe(const std::vector<Register> &table)
{
	std::string text = R"(<?xml version="1.0" encoding="utf-8"?>
<RegisterDescription ModelName="Simulated" VendorName="Pongeye" StandardNameSpace="GEV" ToolTip="A simulated camera"
	SchemaMajorVersion="1" SchemaMinorVersion="1" SchemaSubMinorVersion="0"
	MajorVersion="1" MinorVersion="0" SubMinorVersion="0"
	ProductGuid="4d6a5d1c-0f0b-4c3c-9d55-3c8b1c6f7a01" VersionGuid="4d6a5d1c-0f0b-4c3c-9d55-3c8b1c6f7a02"
	xmlns="http://www.genicam.org/GenApi/Version_1_1">
)";
	text += category_tree(table);
	for (const Register &place : table)
		if (*place.category)
			text += feature(place);
	text += packet_size_features();
	for (const ChunkFeature &chunk : chunk_features)
		text += chunk_feature(chunk);
	text += R"(<Integer Name="TLParamsLocked"><Visibility>Invisible</Visibility><Value>0</Value><Min>0</Min><Max>1</Max></Integer>
<Port Name="Device" NameSpace="Standard"></Port>
</RegisterDescription>
)";
	return text;
}

} // namespace gige
