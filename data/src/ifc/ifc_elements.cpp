#include "ifc_access.h"
#include "part21_scanner.h"

#include <map>

namespace hoist {
namespace ifc {
namespace {

// The concrete subtypes of IfcElement of IFC2x3 and IFC4 that are things: not openings,
// voids, projections and virtual elements (buildingSMART: IFC4 ADD2 TC1,
// IfcProductExtension and the domain schemas; IFC2x3 TC1, likewise).
const char* const elements[] = {
    "IfcActuator",
    "IfcAirTerminal",
    "IfcAirTerminalBox",
    "IfcAirToAirHeatRecovery",
    "IfcAlarm",
    "IfcAudioVisualAppliance",
    "IfcBeam",
    "IfcBeamStandardCase",
    "IfcBoiler",
    "IfcBuildingElementPart",
    "IfcBuildingElementProxy",
    "IfcBurner",
    "IfcCableCarrierFitting",
    "IfcCableCarrierSegment",
    "IfcCableFitting",
    "IfcCableSegment",
    "IfcChiller",
    "IfcChimney",
    "IfcCivilElement",
    "IfcCoil",
    "IfcColumn",
    "IfcColumnStandardCase",
    "IfcCommunicationsAppliance",
    "IfcCompressor",
    "IfcCondenser",
    "IfcController",
    "IfcCooledBeam",
    "IfcCoolingTower",
    "IfcCovering",
    "IfcCurtainWall",
    "IfcDamper",
    "IfcDiscreteAccessory",
    "IfcDistributionChamberElement",
    "IfcDistributionControlElement",
    "IfcDistributionElement",
    "IfcDistributionFlowElement",
    "IfcDoor",
    "IfcDoorStandardCase",
    "IfcDuctFitting",
    "IfcDuctSegment",
    "IfcDuctSilencer",
    "IfcElectricalElement",
    "IfcElectricAppliance",
    "IfcElectricDistributionBoard",
    "IfcElectricDistributionPoint",
    "IfcElectricFlowStorageDevice",
    "IfcElectricGenerator",
    "IfcElectricMotor",
    "IfcElectricTimeControl",
    "IfcElementAssembly",
    "IfcEnergyConversionDevice",
    "IfcEngine",
    "IfcEquipmentElement",
    "IfcEvaporativeCooler",
    "IfcEvaporator",
    "IfcFan",
    "IfcFastener",
    "IfcFilter",
    "IfcFireSuppressionTerminal",
    "IfcFlowController",
    "IfcFlowFitting",
    "IfcFlowInstrument",
    "IfcFlowMeter",
    "IfcFlowMovingDevice",
    "IfcFlowSegment",
    "IfcFlowStorageDevice",
    "IfcFlowTerminal",
    "IfcFlowTreatmentDevice",
    "IfcFooting",
    "IfcFurnishingElement",
    "IfcFurniture",
    "IfcGeographicElement",
    "IfcHeatExchanger",
    "IfcHumidifier",
    "IfcInterceptor",
    "IfcJunctionBox",
    "IfcLamp",
    "IfcLightFixture",
    "IfcMechanicalFastener",
    "IfcMedicalDevice",
    "IfcMember",
    "IfcMemberStandardCase",
    "IfcMotorConnection",
    "IfcOutlet",
    "IfcPile",
    "IfcPipeFitting",
    "IfcPipeSegment",
    "IfcPlate",
    "IfcPlateStandardCase",
    "IfcProtectiveDevice",
    "IfcProtectiveDeviceTrippingUnit",
    "IfcProxy",
    "IfcPump",
    "IfcRailing",
    "IfcRamp",
    "IfcRampFlight",
    "IfcReinforcingBar",
    "IfcReinforcingMesh",
    "IfcRoof",
    "IfcSanitaryTerminal",
    "IfcSensor",
    "IfcShadingDevice",
    "IfcSlab",
    "IfcSlabElementedCase",
    "IfcSlabStandardCase",
    "IfcSolarDevice",
    "IfcSpaceHeater",
    "IfcStackTerminal",
    "IfcStair",
    "IfcStairFlight",
    "IfcSwitchingDevice",
    "IfcSystemFurnitureElement",
    "IfcTank",
    "IfcTendon",
    "IfcTendonAnchor",
    "IfcTransformer",
    "IfcTransportElement",
    "IfcTubeBundle",
    "IfcUnitaryControlElement",
    "IfcUnitaryEquipment",
    "IfcValve",
    "IfcVibrationIsolator",
    "IfcWall",
    "IfcWallElementedCase",
    "IfcWallStandardCase",
    "IfcWasteTerminal",
    "IfcWindow",
    "IfcWindowStandardCase",
};

const std::map<std::string, std::string, std::less<>>&
byUpperCase()
{
  static const auto names = [] {
    std::map<std::string, std::string, std::less<>> out;
    for (const char* const name : elements)
      out.emplace(part21::upperCase(name), name);
    return out;
  }();
  return names;
}

} // namespace

bool
isElement(std::string_view entity)
{
  return byUpperCase().count(entity) != 0;
}

std::string
spelling(std::string_view entity)
{
  const auto found = byUpperCase().find(entity);
  return found == byUpperCase().end() ? std::string(entity) : found->second;
}

} // namespace ifc
} // namespace hoist
