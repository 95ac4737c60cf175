#pragma once

// Things and models that the tests of IFC are about.

#include <hoist/data/ifc/ifc_edit.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace hoist {
namespace test {

/** \brief A box somewhere within 20 m, turned any way, sides 2 cm to 3 m. */
inline OrientedBox
randomBox(std::mt19937& random)
{
  std::uniform_real_distribution<double> share(-1, 1);
  OrientedBox box;
  box.center = 20 * Eigen::Vector3d(share(random), share(random), share(random));
  for (int i = 0; i < 3; ++i)
    box.size[i] = 0.02 + 1.49 * (1 + share(random));
  box.axes =
      Eigen::Quaterniond(share(random), share(random), share(random), share(random))
          .normalized()
          .toRotationMatrix();
  return box;
}

/** \brief The largest distance of a corner of one box to the nearest one of the other
 *  [m]. */
inline double
cornerDistance(const OrientedBox& a, const OrientedBox& b)
{
  const auto corner = [](const OrientedBox& box, int i) -> Eigen::Vector3d {
    const Eigen::Vector3d half = box.size / 2;
    return box.center + box.axes * Eigen::Vector3d((i & 1) != 0 ? half.x() : -half.x(),
                                                   (i & 2) != 0 ? half.y() : -half.y(),
                                                   (i & 4) != 0 ? half.z() : -half.z());
  };
  double worst = 0;
  for (int i = 0; i < 8; ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int j = 0; j < 8; ++j)
      nearest = std::min(nearest, (corner(a, i) - corner(b, j)).norm());
    worst = std::max(worst, nearest);
  }
  return worst;
}

inline IfcObject
thing(const std::string& key, const OrientedBox& box)
{
  IfcObject object;
  object.key = key;
  object.name = "thing " + key;
  object.object_type = "crate";
  object.box = box;
  return object;
}

inline OrientedBox
boxAt(double x, double y, double z)
{
  OrientedBox box;
  box.center = Eigen::Vector3d(x, y, z);
  box.size = Eigen::Vector3d(0.6, 0.4, 0.3);
  return box;
}

inline IfcModel
modelOf(const std::string& bytes)
{
  return IfcModel(Part21File::parse(bytes, "model.ifc"));
}

/** \brief The bytes of a model after an edit. */
template <typename Change>
std::string
edited(const std::string& bytes, Change&& change)
{
  const IfcModel model = modelOf(bytes);
  IfcEdit edit(model);
  change(edit);
  return edit.part21().bytes();
}

/** \brief A model as another program would export it: millimetres, one placement that
 *  two walls share, shared directions, mapped columns, spaces behind "=". */
inline std::string
exportedModel()
{
  return R"(ISO-10303-21;
HEADER;
/* made by nobody */
FILE_DESCRIPTION(('ViewDefinition [CoordinationView_V2.0]'),'2;1');
FILE_NAME('m','2021-02-18T11:55:05',(''),(''),'','','');
FILE_SCHEMA(('IFC2X3'));
ENDSEC;

DATA;
#1= IFCORGANIZATION($,'Somebody \X\DF',$,$,$);
#5= IFCAPPLICATION(#1,'2021','A program','prog');
#6= IFCCARTESIANPOINT((0.,0.,0.));
#9= IFCCARTESIANPOINT((0.,0.));
#11= IFCDIRECTION((1.,0.,0.));
#15= IFCDIRECTION((0.,1.,0.));
#19= IFCDIRECTION((0.,0.,1.));
#31= IFCAXIS2PLACEMENT3D(#6,$,$);
#32= IFCLOCALPLACEMENT(#147,#31);
#35= IFCPERSON($,'','X',$,$,$,$,$);
#37= IFCORGANIZATION($,'','',$,$);
#38= IFCPERSONANDORGANIZATION(#35,#37,$);
#41= IFCOWNERHISTORY(#38,#5,$,.NOCHANGE.,$,$,$,1613601788);
#42= IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);
#43= IFCSIUNIT(*,.MASSUNIT.,.KILO.,.GRAM.);
#44= IFCUNITASSIGNMENT((#42,#43));
#108= IFCAXIS2PLACEMENT3D(#6,$,$);
#111= IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,0.01,#108,$);
#116= IFCGEOMETRICREPRESENTATIONSUBCONTEXT('Body','Model',*,*,*,*,#111,$,.MODEL_VIEW.,$);
#119= IFCPROJECT('39ashYNBDEDR$HhF_Vv5pT',#41,'3458',$,$,'A hall',$,(#111),#44);
#129= IFCBUILDING('39ashYNBDEDR$HhF_Vv5pS',#41,'',$,$,#32,$,'',.ELEMENT.,$,$,$);
#135= IFCAXIS2PLACEMENT3D(#6,#19,#15);
#136= IFCLOCALPLACEMENT(#32,#135);
#138= IFCBUILDINGSTOREY('39ashYNBDEDR$HhFzW6w9a',#41,'Level 1',$,$,#136,$,'Level 1',.ELEMENT.,0.);
#140= IFCCARTESIANPOINT((0.,0.,3140.));
#142= IFCAXIS2PLACEMENT3D(#140,$,$);
#143= IFCLOCALPLACEMENT(#32,#142);
#144= IFCBUILDINGSTOREY('39ashYNBDEDR$HhFzW6zmQ',#41,'Level 2',$,$,#143,$,'Level 2',.ELEMENT.,3140.);
#145= IFCCARTESIANPOINT((5000.,-2000.,100.));
#146= IFCAXIS2PLACEMENT3D(#145,$,$);
#147= IFCLOCALPLACEMENT($,#146);
#148= IFCSITE('39ashYNBDEDR$HhF_Vv5pV',#41,'Default',$,$,#147,$,$,.ELEMENT.,$,$,0.,$,$);
#150= IFCRELAGGREGATES('2V77wsE0r5MQR$Rh7MmJbX',#41,$,$,#119,(#148));
#151= IFCRELAGGREGATES('2V77wsE0r5MQR$Rh7MmJbY',#41,$,$,#148,(#129));
#152= IFCRELAGGREGATES('2V77wsE0r5MQR$Rh7MmJbZ',#41,$,$,#129,(#138,#144));
#164= IFCCARTESIANPOINT((-150.,-200.));
#166= IFCCARTESIANPOINT((150.,-200.));
#168= IFCCARTESIANPOINT((150.,200.));
#170= IFCCARTESIANPOINT((-150.,200.));
#176= IFCPOLYLINE((#164,#166,#168,#170,#164));
#178= IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,'300x400',#176);
#179= IFCCARTESIANPOINT((1000.,2000.,0.));
#181= IFCAXIS2PLACEMENT3D(#179,#19,#11);
#182= IFCEXTRUDEDAREASOLID(#178,#181,#19,3000.);
#192= IFCSHAPEREPRESENTATION(#116,'Body','SweptSolid',(#182));
#195= IFCAXIS2PLACEMENT3D(#6,$,$);
#196= IFCREPRESENTATIONMAP(#195,#192);
#201= IFCMATERIAL('Concrete, gray');
#220= IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#6,1.,$);
#221= IFCMAPPEDITEM(#196,#220);
#223= IFCSHAPEREPRESENTATION(#116,'Body','MappedRepresentation',(#221));
#225= IFCPRODUCTDEFINITIONSHAPE($,$,(#223));
#229= IFCAXIS2PLACEMENT3D(#6,$,$);
#230= IFCLOCALPLACEMENT(#136,#229);
#232= IFCCOLUMN('20hzUDJSj9yPeKYPrwcR7N',#41,'Column 1',$,'300x400',#230,#225,'669490');
#241= IFCPROPERTYSINGLEVALUE('Reference',$,IFCIDENTIFIER('300x400'),$);
#244= IFCPROPERTYSET('0uNK5AgoP1Vw6UlaHiS$iF',#41,'Pset_ColumnCommon',$,(#241));
#254= IFCRELDEFINESBYPROPERTIES('22xWFM12z0bBHzUfaDXCX3',#41,$,$,(#232,#332),#244);
#255= IFCQUANTITYWEIGHT('GrossWeight',$,$,864.);
#256= IFCELEMENTQUANTITY('22xWFM12z0bBHzUfaDXCX4',#41,'BaseQuantities',$,$,(#255));
#257= IFCRELDEFINESBYPROPERTIES('22xWFM12z0bBHzUfaDXCX5',#41,$,$,(#232),#256);
#258= IFCRELASSOCIATESMATERIAL('22xWFM12z0bBHzUfaDXCX6',#41,$,$,(#232,#332),#201);
#300= IFCAXIS2PLACEMENT2D(#9,$);
#301= IFCRECTANGLEPROFILEDEF(.AREA.,$,#300,4000.,200.);
#302= IFCEXTRUDEDAREASOLID(#301,#31,#19,2500.);
#303= IFCSHAPEREPRESENTATION(#116,'Body','SweptSolid',(#302));
#304= IFCPRODUCTDEFINITIONSHAPE($,$,(#303));
#305= IFCAXIS2PLACEMENT3D(#6,$,$);
#306= IFCLOCALPLACEMENT(#143,#305);
#332= IFCWALLSTANDARDCASE('20hzUDJSj9yPeKYPrwcRop',#41,'Wall 1',$,$,#306,#304,$);
#333= IFCWALLSTANDARDCASE('20hzUDJSj9yPeKYPrwcRoq',#41,'Wall 2',$,$,#306,#304,$);
#340= IFCRELCONTAINEDINSPATIALSTRUCTURE('20hzUDJSj9yPeKYPrwcRor',#41,$,$,(#232 ),#138);
#341= IFCRELCONTAINEDINSPATIALSTRUCTURE('20hzUDJSj9yPeKYPrwcRos',#41,$,$,(#332,#333),#144);
ENDSEC;

END-ISO-10303-21;
)";
}

} // namespace test
} // namespace hoist
