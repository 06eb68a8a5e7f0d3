"""Small scenes, rotors and packages, all of them right: what is damaged."""

from __future__ import annotations

from touchdown.master.interop.ssp.xml import NAMESPACES

ROTOR = """title = "Stub"
damping_ratio = 0.01

[material.steel]
modulus = "207 GPa"
density = "7830 kg/m3"
poisson = 0.3

[[element]]
length = "40 mm"
count = 3
outer_diameter = "20 mm"
sleeve = { outer_diameter = "55 mm", material = "steel" }

[[element]]
position = "120 mm"
length = "50 mm"
outer_diameter = "20 mm"
inner_diameter = "5 mm"

[[disc]]
node = 3
outer_diameter = "80 mm"
inner_diameter = "30 mm"
width = "10 mm"

[[point_mass]]
node = 4
mass = "100 g"
polar_inertia = "200 kg.mm2"

[[unbalance]]
node = 3
moment = "3 g.mm"
angle = "90 deg"

[stations]
A = 1
amb = 3

[sensors]
near = 2
"""

TURNING = """title = "A rotor alone"

[run]
duration = 1e-4
macro_step = 2e-5

[components.rotor]
fmu = "rotor.toml"

[components.rotor.set]
modes = 3
"""

DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="m" guid="{g}" generationTool="none">
<CoSimulation modelIdentifier="m" canGetAndSetFMUstate="true"/>
<UnitDefinitions>
<Unit name="mm"><BaseUnit m="1" factor="0.001" offset="0.5"/></Unit>
<Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
</UnitDefinitions>
<ModelVariables>
<ScalarVariable name="A.x" valueReference="0" causality="output"><Real unit="mm"/></ScalarVariable>
<ScalarVariable name="A.fx" valueReference="1" causality="input"><Real unit="N" start="0"/></ScalarVariable>
<ScalarVariable name="k" valueReference="2" causality="parameter" variability="fixed">
<Real start="1.5" min="0" max="9"/></ScalarVariable>
<ScalarVariable name="n" valueReference="0" causality="parameter" variability="fixed">
<Integer start="2"/></ScalarVariable>
</ModelVariables>
<ModelStructure><Outputs><Unknown index="1"/></Outputs></ModelStructure>
</fmiModelDescription>
"""

STRUCTURE = f"""<?xml version="1.0" encoding="UTF-8"?>
<ssd:SystemStructureDescription {" ".join(f'xmlns:{k}="{v}"' for k, v in NAMESPACES.items())}
version="1.0" name="two">
<ssd:System name="two" description="Two of a kind">
<ssd:Elements>
<ssd:Component name="a" source="resources/m.fmu" type="application/x-fmu-sharedlibrary">
<ssd:Connectors>
<ssd:Connector name="A.x" kind="output"><ssc:Real unit="mm"/></ssd:Connector></ssd:Connectors>
<ssd:ParameterBindings><ssd:ParameterBinding><ssd:ParameterValues>
<ssv:ParameterSet version="1.0" name="s"><ssv:Parameters>
<ssv:Parameter name="k"><ssv:Real value="2.5"/></ssv:Parameter>
<ssv:Parameter name="n"><ssv:Integer value="3"/></ssv:Parameter>
</ssv:Parameters></ssv:ParameterSet>
</ssd:ParameterValues></ssd:ParameterBinding></ssd:ParameterBindings>
<ssd:Annotations><ssc:Annotation type="com.opensimulationplatform">
<osp:StepSizeHint value="0.002"/></ssc:Annotation></ssd:Annotations>
</ssd:Component>
<ssd:Component name="b" source="resources/m.fmu">
<ssd:ParameterBindings><ssd:ParameterBinding source="b.ssv"/></ssd:ParameterBindings>
</ssd:Component>
</ssd:Elements>
<ssd:Connections>
<ssd:Connection startElement="a" startConnector="A.x" endElement="b" endConnector="A.fx"
suppressUnitConversion="true">
<ssc:LinearTransformation factor="2.0" offset="1.0"/></ssd:Connection>
<ssd:Connection startConnector="outer" endElement="a" endConnector="A.fx"/>
</ssd:Connections>
<ssd:ParameterBindings><ssd:ParameterBinding><ssd:ParameterValues>
<ssv:ParameterSet version="1.0" name="o"><ssv:Parameters>
<ssv:Parameter name="outer"><ssv:Real value="1.0" unit="N"/></ssv:Parameter>
</ssv:Parameters></ssv:ParameterSet></ssd:ParameterValues></ssd:ParameterBinding></ssd:ParameterBindings>
</ssd:System>
<ssd:Units><ssd:Unit name="mm"><ssc:BaseUnit m="1" factor="0.001"/></ssd:Unit></ssd:Units>
<ssd:DefaultExperiment startTime="0.0" stopTime="5.5">
<ssd:Annotations><ssc:Annotation type="com.opensimulationplatform">
<osp:Algorithm><osp:FixedStepAlgorithm baseStepSize="0.001"/></osp:Algorithm>
</ssc:Annotation></ssd:Annotations>
</ssd:DefaultExperiment>
<ssd:Annotations><ssc:Annotation type="touchdown-cosim.scene">
<touchdown:Scene scheme="hold" zero="a.stiffness" record_every="2" tolerance="1e-9">
<touchdown:Name component="a" name="stiffness" own="k"/></touchdown:Scene></ssc:Annotation>
</ssd:Annotations>
</ssd:SystemStructureDescription>
"""
VALUES = f"""<?xml version="1.0" encoding="UTF-8"?>
<ssv:ParameterSet xmlns:ssv="{NAMESPACES["ssv"]}" xmlns:ssc="{NAMESPACES["ssc"]}" version="1.0" name="v">
<ssv:Parameters><ssv:Parameter name="k"><ssv:Real value="1.0"/></ssv:Parameter></ssv:Parameters>
<ssv:Units><ssv:Unit name="N"><ssc:BaseUnit kg="1" m="1" s="-2"/></ssv:Unit></ssv:Units>
</ssv:ParameterSet>
"""
